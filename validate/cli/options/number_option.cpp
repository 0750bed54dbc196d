#include "number_option.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"

namespace detp::cli {

double parse_number(std::string_view option, std::string_view text) {
  double value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error == std::errc::result_out_of_range && end == last)
    throw std::invalid_argument(
        fmt::format("{} must lie within ±1.8e308 and be 0 or beyond ±4.9e-324 (got {})", option, detp::quoted(text)));
  if (error != std::errc{} || end != last || !std::isfinite(value))
    throw std::invalid_argument(
        fmt::format("{} must be one decimal number, as 1000 or 2.5e-3 (got {})", option, detp::quoted(text)));
  return value;
}

std::int64_t parse_whole(std::string_view option, std::string_view text, std::int64_t least, std::int64_t most) {
  const auto refuse = [&] {
    throw std::invalid_argument(
        fmt::format("{} must be a whole number from {} to {} (got {})", option, least, most, detp::quoted(text)));
  };
  std::int64_t value = 0;
  const char* const last = text.data() + text.size();
  if (const auto [end, error] = std::from_chars(text.data(), last, value); error != std::errc{} || end != last) {
    const double number = parse_number(option, text);
    constexpr double beyond = 9223372036854775808.0;  // 2⁶³
    if (!(std::trunc(number) == number && number >= -beyond && number < beyond)) refuse();
    value = static_cast<std::int64_t>(number);
  }
  if (value < least || value > most) refuse();
  return value;
}

std::uint64_t parse_seed(std::string_view option, std::string_view text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size())
    throw std::invalid_argument(fmt::format("{} must be a whole number from 0 to {} (got {})", option,
                                            std::numeric_limits<std::uint64_t>::max(), detp::quoted(text)));
  return seed;
}

SeedRange parse_seeds(std::string_view option, std::string_view text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto refuse = [&] {
    throw std::invalid_argument(
        fmt::format("{} takes the first and the last seed, as 1:100 (got {})", option, detp::quoted(text)));
  };
  if (colon == text.size()) refuse();
  const SeedRange seeds{parse_seed(option, text.substr(0, colon)), parse_seed(option, text.substr(colon + 1))};
  if (seeds.last < seeds.first) refuse();
  return seeds;
}

std::string without_count_suffix(std::string_view text) {
  const std::string_view digits = text.substr(0, text.empty() ? 0 : text.size() - 1);
  if (digits.empty() || digits.find_first_not_of("0123456789.") != std::string_view::npos) return std::string(text);
  const char suffix = text.back();
  const char* const exponent = suffix == 'k' ? "e3" : suffix == 'M' ? "e6" : suffix == 'G' ? "e9" : nullptr;
  return exponent == nullptr ? std::string(text) : std::string(digits) + exponent;
}

double parse_count(std::string_view option, std::string_view text) {
  return parse_number(option, without_count_suffix(text));
}

double parse_share(std::string_view option, std::string_view text) {
  const bool percentage = text.ends_with('%');
  try {
    const double number = parse_number(option, text.substr(0, text.size() - (percentage ? 1 : 0)));
    return percentage ? number / 100 : number;
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(
        fmt::format("{} must be a number or a percentage, as 0.05 or 5% (got {})", option, detp::quoted(text)));
  }
}

}  // namespace detp::cli
