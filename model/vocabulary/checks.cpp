#include "checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace detp {
namespace {

[[noreturn]] void refuse(std::string_view what, std::string_view rule, double value) {
  throw std::invalid_argument(fmt::format("{} must be {} (got {})", what, rule, value));
}

}  // namespace

void require_positive(std::string_view what, double value) {
  if (!(value > 0 && std::isfinite(value))) refuse(what, "> 0 and finite", value);
}

void require_non_negative(std::string_view what, double value) {
  if (!(value >= 0 && std::isfinite(value))) refuse(what, ">= 0 and finite", value);
}

void require_finite(std::string_view what, double value) {
  if (!std::isfinite(value)) refuse(what, "finite", value);
}

void require_ratio(std::string_view what, double value) {
  if (!(value > 0 && value < 1)) refuse(what, "between 0 and 1, both excluded", value);
}

void require_share(std::string_view what, double value) {
  if (!(value >= 0 && value <= 1)) refuse(what, "from 0 to 1", value);
}

void require_count(std::string_view what, double value, double least, double most) {
  if (!(value >= least && value <= most && value == std::floor(value)))
    refuse(what, fmt::format("a whole number from {} to {}", least, most), value);
}

}  // namespace detp
