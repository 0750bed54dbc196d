#include "calibration_quality.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace detp::validate {

std::string CalibrationQuality::doubt() const {
  std::string why;
  if (probe) return why;
  if (left_out_median_error > doubtful_error)
    why = fmt::format("its median error is {:.2g} %, more than {:.2g} %", 100 * left_out_median_error,
                      100 * doubtful_error);
  if (processor_share < doubtful_share)
    why += fmt::format("{}other programs took {:.2g} % of the time of its runs", why.empty() ? "" : "; ",
                       100 * (1 - processor_share));
  return why;
}

double CalibrationQuality::relative_error() const {
  constexpr double median_of_normal = 0.6745;  // of |x|, in standard deviations
  return std::max(left_out_median_error / median_of_normal, 1 - processor_share);
}

bool CalibrationQuality::is_better_than(const CalibrationQuality& other) const {
  if (probe != other.probe) return other.probe;
  if (doubt().empty() != other.doubt().empty()) return doubt().empty();
  return relative_error() < other.relative_error();
}

}  // namespace detp::validate
