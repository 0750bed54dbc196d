#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/input_file.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/validate/base/json.hpp"
#include "reference.hpp"

namespace detp::validate {
namespace {

using Json = nlohmann::ordered_json;

constexpr int version = 3;  // of the file
constexpr int methods = 3;  // change it whenever make_reference gives other values
constexpr std::string_view reference_schema = "detp.reference";
constexpr std::size_t most_bytes_of_reference = std::size_t{1} << 30;
constexpr std::size_t numbers_of_sample = 10;

/// Adds a light's numbers.
struct AddLight {
  Digest& digest;

  void operator()(const sim::PointLight& light) const { digest.add(light.position); }
  void operator()(const sim::AreaLight& light) const {
    for (const glm::dvec3& one : {light.corner, light.edge_u, light.edge_v}) digest.add(one);
  }
  void operator()(const sim::SpotLight& light) const {
    digest.add(light.position);
    digest.add(light.direction);
    digest.add(light.half_angle);
  }
  void operator()(const sim::DirectionalLight& light) const { digest.add(light.direction); }
  void operator()(const sim::EnvironmentLight&) const {}
  void operator()(const sim::SurfaceLight&) const {}
};

std::string digest_of_scene(const sim::Scene& scene) {
  Digest digest;
  digest.add(scene.mesh.positions.size());
  for (const glm::dvec3& position : scene.mesh.positions) digest.add(position);
  for (const glm::dvec3& normal : scene.mesh.normals) digest.add(normal);
  for (const auto& triangle : scene.mesh.triangles)
    for (const std::uint32_t corner : triangle) digest.add(std::uint64_t{corner});
  for (const sim::Material& one : scene.mesh.materials.all)
    for (const double value : {one.diffuse, one.specular, one.shininess, one.glass, one.index, one.emitted})
      digest.add(value);
  for (const std::uint16_t material : scene.mesh.materials.of_triangle) digest.add(std::uint64_t{material});
  if (const auto& backs = scene.mesh.materials.of_back; !backs.empty()) digest.add(std::uint64_t{backs.size()});
  for (const std::uint16_t material : scene.mesh.materials.of_back) digest.add(std::uint64_t{material});
  for (const sim::Light& light : scene.lights) {
    digest.add(std::uint64_t{light.shape.index()});
    digest.add(light.flux);
    std::visit(AddLight{digest}, light.shape);
  }
  digest.add(std::uint64_t{scene.samples.size()});
  for (const sim::Sample& sample : scene.samples) {
    digest.add(sample.position);
    digest.add(sample.normal);
  }
  return digest.text();
}

Json key_json(const ReferenceKey& key) {
  return {{"scene", key.scene},
          {"front_facing", key.front_facing},
          {"samples", key.samples},
          {"seed", key.seed},
          {"version", key.version}};
}

void check_key(const Json& stored, const ReferenceKey& wanted, const std::string& path) {
  const Json here = key_json(wanted);
  for (const auto& [name, value] : here.items())
    if (stored.at(name) != value)
      throw sim::FileError(
          path, fmt::format("is the reference of another {}: {}, here it is {}; give another file, or delete this one",
                            name == "scene" ? "scene, or of other lights, materials or samples" : name,
                            shortened(stored.at(name).dump(), 40), value.dump()));
}

/// Of a file's members, without its checksum.
std::string checksum_of_reference(Json members, const Json& samples) {
  members.erase("checksum");
  members["samples"] = samples;
  return checksum(members);
}

ReferenceKind kind_named(const std::string& text) {
  for (const ReferenceKind kind : {ReferenceKind::known, ReferenceKind::backward, ReferenceKind::both})
    if (name(kind) == text) return kind;
  throw std::invalid_argument("its kind is " + detp::quoted(text));
}

/// JSON has no numbers that are not finite.
void add_sample(const Json& numbers, std::size_t samples_of_scene, Reference& reference) {
  if (!numbers.is_array() || numbers.size() != numbers_of_sample)
    throw std::invalid_argument(fmt::format("a sample needs {} numbers", numbers_of_sample));
  sim::Sample sample;
  for (int axis = 0; axis < 3; ++axis) {
    sample.position[axis] = numbers[axis];
    sample.normal[axis] = numbers[3 + axis];
  }
  reference.judged.samples.push_back(sample);
  reference.irradiance.push_back(numbers[6]);
  reference.variance.push_back(numbers[7]);
  if (reference.variance.back() < 0) throw std::invalid_argument("a variance is below 0");
  reference.judged.weights.push_back(numbers[8]);
  reference.judged.places.push_back(numbers[9]);
  if (reference.judged.places.back() >= samples_of_scene)
    throw std::invalid_argument("a sample is not one of the scene's");
}

}  // namespace

ReferenceKey reference_key(const sim::Scene& scene, const ReferenceOptions& options) {
  return {.scene = digest_of_scene(scene),
          .front_facing = options.front_facing,
          .samples = options.samples,
          .seed = options.seed,
          .version = methods};
}

void write_reference(const std::string& path, const Reference& reference, const ReferenceKey& key) {
  Json head{{"schema", {{"name", reference_schema}, {"version", version}}},
            {"key", key_json(key)},
            {"name", reference.scene},
            {"kind", name(reference.kind)},
            {"paths", reference.paths},
            {"photons", reference.photons},
            {"population", reference.judged.population},
            {"missed_squared", {reference.missed_squared.mean, reference.missed_squared.standard_error}},
            {"missed_mean", reference.missed_mean},
            {"path_noise_squared", reference.path_noise_squared},
            {"error", reference.error()},
            {"seconds", reference.seconds},
            {"columns", {"x", "y", "z", "nx", "ny", "nz", "irradiance", "variance", "weight", "place"}}};
  Json samples = Json::array();
  for (std::size_t i = 0; i < reference.irradiance.size(); ++i) {
    const sim::Sample& sample = reference.judged.samples[i];
    const auto& [p, n] = std::pair(sample.position, sample.normal);
    samples.push_back({p.x, p.y, p.z, n.x, n.y, n.z, reference.irradiance[i], reference.variance[i],
                       reference.judged.weights[i], reference.judged.places[i]});
  }
  head["checksum"] = checksum_of_reference(head, samples);
  sim::OutputFile file(path);
  std::string text = head.dump(2);
  text.erase(text.rfind('\n'));
  file.write(text + ",\n  \"samples\": [");
  for (std::size_t i = 0; i < samples.size(); ++i) file.write((i == 0 ? "\n    " : ",\n    ") + samples[i].dump());
  file.write("\n  ]\n}\n");
  file.commit();
}

Reference read_reference(const std::string& path, const sim::Scene& scene, const ReferenceOptions& options) {
  try {
    const ReferenceKey key = reference_key(scene, options);
    const Json json = Json::parse(sim::read_file(path, most_bytes_of_reference));
    if (json.at("schema").at("name") != reference_schema || json.at("schema").at("version") != version)
      throw sim::FileError(path, "is not a reference of this version of detp");
    check_key(json.at("key"), key, path);
    Reference reference{
        .scene = json.at("name"), .kind = kind_named(json.at("kind")), .judged = {}, .irradiance = {}, .variance = {}};
    reference.paths = json.at("paths");
    reference.photons = json.at("photons");
    reference.judged.population = json.at("population");
    reference.missed_squared = {json.at("missed_squared").at(0), json.at("missed_squared").at(1)};
    reference.missed_mean = json.at("missed_mean");
    reference.path_noise_squared = json.at("path_noise_squared");
    reference.seconds = json.at("seconds");
    for (const Json& numbers : json.at("samples")) add_sample(numbers, scene.samples.size(), reference);
    const std::size_t samples = std::min(key.samples, reference.judged.population);
    if (reference.irradiance.size() != samples)
      throw std::invalid_argument(fmt::format("it has {} samples, not {}", reference.irradiance.size(), samples));
    if (json.at("checksum") != checksum_of_reference(json, json.at("samples")))
      throw sim::FileError(path, "was altered: it does not fit its checksum; give another file, or delete this one");
    return reference;
  } catch (const nlohmann::json::exception& error) {
    throw sim::FileError(path, fmt::format("is not a reference: {}", shortened(error.what(), 150)));
  } catch (const std::invalid_argument& error) {
    throw sim::FileError(path, fmt::format("is not a reference: {}", error.what()));
  }
}

Reference kept_reference(const std::string& path, const sim::Scene& scene, const ReferenceOptions& options) {
  if (std::filesystem::exists(path)) return read_reference(path, scene, options);
  Reference reference = make_reference(scene, options);
  if (!options.stop.stop_requested()) write_reference(path, reference, reference_key(scene, options));
  return reference;
}

}  // namespace detp::validate
