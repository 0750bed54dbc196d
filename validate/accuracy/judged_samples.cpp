#include "judged_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "detp/sim/geometry/random.hpp"

namespace detp::validate {

namespace {

double area_of_triangle(const sim::Mesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  const glm::dvec3& a = mesh.positions[corners[0]];
  return 0.5 * glm::length(glm::cross(mesh.positions[corners[1]] - a, mesh.positions[corners[2]] - a));
}

/// For each triangle, whether neither of its sides scatters light diffusely, and one scatters it.
std::vector<bool> mirrors(const sim::Mesh& mesh) {
  std::vector<bool> found(mesh.triangles.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const sim::Material& front = mesh.materials.of(i, true);
    const sim::Material& back = mesh.materials.of(i, false);
    found[i] = front.diffuse == 0 && back.diffuse == 0 && front.specular + front.glass + back.specular + back.glass > 0;
  }
  return found;
}

}  // namespace

double mirror_share(const sim::Mesh& mesh) {
  const std::vector<bool> is_mirror = mirrors(mesh);
  double all = 0;
  double of_mirrors = 0;
  for (std::size_t i = 0; i < is_mirror.size(); ++i) {
    const double area = area_of_triangle(mesh, mesh.triangles[i]);
    all += area;
    if (is_mirror[i]) of_mirrors += area;
  }
  return all > 0 ? of_mirrors / all : 0;
}

std::string mirror_notice(double share) {
  if (!(share > 0)) return {};
  return fmt::format("errors are without mirrors and glass, {:.2g} % of the area, where irradiance is not used",
                     100 * share);
}

std::vector<double> area_weights(const sim::Scene& scene, Surfaces surfaces) {
  const sim::Mesh& mesh = scene.mesh;
  std::vector<bool> counts(mesh.triangles.size(), true);
  if (surfaces == Surfaces::without_mirrors) counts = mirrors(mesh), counts.flip();
  std::vector<double> around(mesh.positions.size());
  std::vector<double> counted(mesh.positions.size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    for (const std::uint32_t corner : mesh.triangles[i]) {
      const double third = area_of_triangle(mesh, mesh.triangles[i]) / 3;
      around[corner] += third;
      if (counts[i]) counted[corner] += third;
    }
  std::vector<double> weights;
  bool all_found = true;
  std::size_t vertex = 0;
  for (const sim::Sample& sample : scene.samples) {
    while (vertex < around.size() && (mesh.positions[vertex] != sample.position || !(around[vertex] > 0))) ++vertex;
    all_found = all_found && vertex < around.size();
    weights.push_back(all_found ? counted[vertex++] : 0);
  }
  if (!all_found) {  // samples between the vertices: each stands for the same area
    const bool all_count = std::ranges::find(counts, false) == counts.end();
    weights.assign(weights.size(), all_count ? 1.0 : 0.0);
    if (!all_count)
      for (const std::size_t place : sim::samples_on(mesh, scene.samples, counts)) weights[place] = 1;
  }
  double sum = 0;
  for (const double weight : weights) sum += weight;
  if (!(sum > 0) && surfaces != Surfaces::all) return area_weights(scene, Surfaces::all);
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<double> weights_by_area(std::span<const sim::Disc> discs) {
  std::vector<double> weights;
  double sum = 0;
  for (const sim::Disc& disc : discs) sum += weights.emplace_back(disc.radius * disc.radius);
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<double> JudgedSamples::of_all(std::span<const double> values) const {
  std::vector<double> own;
  own.reserve(places.size());
  for (const std::size_t place : places) own.push_back(values[place]);
  return own;
}

void keep_named(std::vector<double>& weights, const sim::Mesh& mesh, std::span<const sim::Sample> samples,
                const sim::FaceNames& names, const std::stop_token& stop) {
  std::vector<double> kept(weights.size());
  double sum = 0;
  for (const std::size_t place : sim::samples_named(mesh, samples, names, stop)) sum += kept[place] = weights[place];
  if (!(sum > 0)) throw std::invalid_argument("the faces that are named have no area at their samples");
  for (double& weight : kept) weight /= sum;
  weights = std::move(kept);
}

JudgedSamples judged_samples(const sim::Scene& scene, std::size_t most, std::span<const double> weights) {
  constexpr std::uint64_t seed = 1;
  std::vector<double> by_area;
  if (weights.empty()) weights = by_area = area_weights(scene);
  JudgedSamples judged;
  judged.population =
      static_cast<std::size_t>(std::ranges::count_if(weights, [](double weight) { return weight > 0; }));
  std::size_t wanted = std::min(most, judged.population);
  std::size_t left = judged.population;
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] > 0))
      continue;  // of the others, each is chosen with the share of the wanted ones in those that are left
    const double number = sim::uniform4(seed, sim::Stream::pilot, i)[0];
    if (number * static_cast<double>(left--) >= static_cast<double>(wanted)) continue;
    --wanted;
    judged.places.push_back(i);
    judged.samples.push_back(scene.samples[i]);
    sum += judged.weights.emplace_back(weights[i]);
  }
  for (double& weight : judged.weights) weight /= sum;
  return judged;
}

}  // namespace detp::validate
