#include "material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace detp::sim {

Colours colours_of(const Material& material) {
  return material.colours.value_or(Colours{glm::dvec3(material.diffuse), glm::dvec3(material.specular),
                                           glm::dvec3(material.glass), glm::dvec3(material.emitted)});
}

void Materials::take_largest() {
  const auto largest = [](const glm::dvec3& colour) { return std::max({colour.r, colour.g, colour.b}); };
  for (Material& one : all) {
    const Colours colours = colours_of(one);
    const double sum = largest(colours.diffuse) + largest(colours.specular) + largest(colours.glass);
    const double lowered = std::max(1.0, sum);
    one.diffuse = largest(colours.diffuse) / lowered;
    one.specular = largest(colours.specular) / lowered;
    one.glass = largest(colours.glass) / lowered;
    one.emitted = largest(colours.emitted);
  }
}

void Materials::take_band(int band) {
  for (Material& one : all) {
    const Colours colours = colours_of(one);
    one.diffuse = colours.diffuse[band];
    one.specular = colours.specular[band];
    one.glass = colours.glass[band];
    one.emitted = colours.emitted[band];
  }
}

void check(const Material& material) {
  const auto require = [&](bool holds, const char* what, double value) {
    if (!holds) throw std::invalid_argument(fmt::format("{} of material '{}' (got {})", what, material.name, value));
  };
  const double shares = material.diffuse + material.specular + material.glass;
  require(material.diffuse >= 0 && material.diffuse <= 1, "albedo must be in [0, 1], that", material.diffuse);
  require(material.specular >= 0 && material.specular <= 1, "specular share must be in [0, 1], that",
          material.specular);
  require(material.glass >= 0 && material.glass <= 1, "share of glass must be in [0, 1], that", material.glass);
  require(shares <= 1 + 1e-12, "diffuse, specular and glass shares must add up to at most 1, those", shares);
  require(material.shininess >= 1, "shininess must be >= 1, that", material.shininess);
  require(material.index > 0 && std::isfinite(material.index), "index of refraction must be > 0 and finite, that",
          material.index);
  require(std::fpclassify(material.emitted) != FP_SUBNORMAL, "emitted radiance must be 0 or a normal number, that",
          material.emitted);
  require(material.emitted >= 0 && std::isfinite(material.emitted), "emitted radiance must be >= 0 and finite, that",
          material.emitted);
}

void check(const Materials& materials, std::size_t triangles) {
  for (const Material& material : materials.all) check(material);
  const auto require_numbers = [&](const std::vector<std::uint16_t>& numbers, const char* what, bool may_be_none) {
    if (numbers.empty()) return;
    if (numbers.size() != triangles)
      throw std::invalid_argument(
          fmt::format("{} needs a material ({} for {} triangles)", what, numbers.size(), triangles));
    for (const std::uint16_t number : numbers)
      if (number >= materials.all.size() && !(may_be_none && number == no_back))
        throw std::invalid_argument(
            fmt::format("there is no material {} (counting from 0); there are {}", number, materials.all.size()));
  };
  require_numbers(materials.of_triangle, "each triangle", false);
  require_numbers(materials.of_back, "each triangle's back", true);
}

}  // namespace detp::sim
