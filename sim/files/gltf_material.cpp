#include "gltf_material.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>

namespace detp::sim {
namespace {

using Json = nlohmann::json;

/// The member of an object; null if there is none.
const Json& member(const Json& object, const char* key) {
  static const Json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

double number_or(const Json& object, const char* key, double otherwise, double most) {
  const Json& found = member(object, key);
  const double number = found.is_number() ? found.get<double>() : otherwise;
  return std::isfinite(number) ? std::clamp(number, 0.0, most) : otherwise;
}

glm::dvec3 colour_or(const Json& object, const char* key, double otherwise, double most) {
  const Json& found = member(object, key);
  glm::dvec3 colour(otherwise);
  for (int i = 0; i < 3; ++i)
    if (found.is_array() && found.size() >= 3 && found[static_cast<std::size_t>(i)].is_number())
      colour[i] = std::clamp(found[static_cast<std::size_t>(i)].get<double>(), 0.0, most);
  return colour;
}

/// Rec. 709, as of MTL.
double luminance_of(const glm::dvec3& colour) {
  if (colour.r == colour.g && colour.g == colour.b) return colour.r;
  return 0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b;
}

}  // namespace

Material gltf_material(const nlohmann::json& from, LeftOut& left_out) {
  constexpr double most = 0.98;
  constexpr double roughness_of_mirrors = 0.05;
  constexpr double most_radiance = 1e30;
  const Json& surface = member(from, "pbrMetallicRoughness");
  const Json& extensions = member(from, "extensions");
  glm::dvec3 base = colour_or(surface, "baseColorFactor", 1, 1);
  if (!member(surface, "baseColorTexture").is_null()) base *= 0.5;
  const double metal = number_or(surface, "metallicFactor", 1, 1);
  const double roughness = number_or(surface, "roughnessFactor", 1, 1);
  const double glass =
      (1 - metal) * number_or(member(extensions, "KHR_materials_transmission"), "transmissionFactor", 0, 1);
  const double index = std::max(1.0, number_or(member(extensions, "KHR_materials_ior"), "ior", 1.5, 100));
  const double reflected = std::pow((index - 1) / (index + 1), 2);
  const double rest = 1 - metal - glass;
  const glm::dvec3 emitted =
      colour_or(from, "emissiveFactor", 0, 1) *
      number_or(member(extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1, most_radiance);
  if (member(from, "alphaMode") == "BLEND" || member(from, "alphaMode") == "MASK")
    ++left_out["transparency by alpha, taken as opaque"];

  Colours colours{.diffuse = base * rest * (1 - reflected),
                  .specular = base * metal + glm::dvec3(reflected * rest),
                  .glass = glm::dvec3(glass),
                  .emitted = emitted};
  for (int band = 0; band < 3; ++band) {
    const double sum = colours.diffuse[band] + colours.specular[band];
    if (sum + glass <= most || sum == 0) continue;
    const double share = std::max(0.0, most - glass) / sum;
    colours.diffuse[band] *= share;
    colours.specular[band] *= share;
  }
  Material to{.diffuse = luminance_of(colours.diffuse), .specular = luminance_of(colours.specular)};
  if (const Json& name = member(from, "name"); name.is_string()) to.name = name.get<std::string>();
  if (roughness >= roughness_of_mirrors) to.shininess = std::max(1.0, (1 / std::pow(roughness, 4) - 1) / 2);
  to.glass = glass;
  to.index = index == 1 ? 1.5 : index;
  to.emitted = luminance_of(emitted);
  if (std::fpclassify(to.emitted) == FP_SUBNORMAL) to.emitted = 0;
  if (base.r != base.g || base.g != base.b || emitted.r != emitted.g || emitted.g != emitted.b) to.colours = colours;
  return to;
}

}  // namespace detp::sim
