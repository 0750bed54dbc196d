#include "map_labels.hpp"

#include <fmt/format.h>

#include "detp/model/vocabulary/quoted.hpp"

namespace detp::validate {

std::string radius_label(const Length& radius) {
  return radius.relative ? fmt::format("{:.3g} %", 100 * radius.value) : fmt::format("{:.3g}", radius.value);
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
