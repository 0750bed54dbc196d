#include "map_labels.hpp"

#include <fmt/format.h>

#include <string>

#include "detp/model/vocabulary/quoted.hpp"

namespace detp::validate {

std::string rays_label(double rays) {
  if (rays < 100) return fmt::format("{:g}", rays);
  const std::string digits = fmt::format("{:.2e}", rays);  // "1.20e+04"
  std::string mantissa = digits.substr(0, 4);
  mantissa.erase(mantissa.find_last_not_of('0') + 1);
  if (mantissa.back() == '.') mantissa.pop_back();
  return fmt::format("{}e{}", mantissa, std::stoi(digits.substr(5)));
}

std::string radius_label(const Length& radius) {
  return radius.relative ? fmt::format("{:.3g} %", 100 * radius.value) : fmt::format("{:.3g}", radius.value);
}

std::string seconds_label(double seconds) {
  const bool short_time = seconds < 0.9995;
  const double shown = short_time ? 1e3 * seconds : seconds;
  const char* const unit = short_time ? "ms" : "s";
  return shown < 99.5 ? fmt::format("{:.2g} {}", shown, unit) : fmt::format("{:.0f} {}", shown, unit);
}

std::string describe(const TechniqueMap& map) {
  const Workload& workload = map.rows.front().workload;
  return fmt::format("{}: {} discs of dimension D = {:.2f}, {}", shown_path(map.name), workload.samples,
                     workload.dimension,
                     map.field == sim::Field::mixed       ? "a mixed field"
                     : map.field == sim::Field::isotropic ? "isotropic lines"
                                                          : "photon paths");
}

}  // namespace detp::validate
