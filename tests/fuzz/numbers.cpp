// Numbers in text: number_in returns the same bits as strtod; parse_length accepts positive lengths only.

#include <bit>
#include <cmath>
#include <stdexcept>

#include "detp/sim/files/number_text.hpp"
#include "detp/validate/job/job.hpp"
#include "scratch.hpp"

namespace {

void require(bool promise) {
  if (!promise) std::abort();
}

/// Text that strtod accepts and number_in does not: leading blanks, hexadecimal digits, and NaNs with a payload.
bool only_strtod_reads(const std::string& text) {
  return text.empty() || text.find_first_of(" \t\n\v\f\rxX(") != std::string::npos ||
         text.find('\0') != std::string::npos;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(detp::fuzz::text_of(data, size));
  const auto number = detp::sim::number_in(text);
  if (!only_strtod_reads(text)) {
    char* end = nullptr;
    const double expected = std::strtod(text.c_str(), &end);
    require(number.has_value() == (end == text.c_str() + text.size()));
    if (number && !std::isnan(expected))
      require(std::bit_cast<std::uint64_t>(*number) == std::bit_cast<std::uint64_t>(expected));
  }
  try {
    const detp::validate::Length length = detp::validate::parse_length(text);
    require(length.value > 0 && std::isfinite(length.value));
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
