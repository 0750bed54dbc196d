#include "judged_samples.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "detp/sim/geometry/random.hpp"

namespace detp::validate {

std::vector<double> area_weights(const sim::Scene& scene) {
  const sim::Mesh& mesh = scene.mesh;
  std::vector<double> around(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const double area =
        0.5 * glm::length(glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
    for (const std::uint32_t corner : {a, b, c}) around[corner] += area / 3;
  }
  std::vector<double> weights;
  std::size_t vertex = 0;
  for (const sim::Sample& sample : scene.samples) {
    while (vertex < around.size() && (mesh.positions[vertex] != sample.position || !(around[vertex] > 0))) ++vertex;
    weights.push_back(vertex < around.size() ? around[vertex++] : 0);
  }
  const auto others = static_cast<double>(std::ranges::count(weights, 0.0));
  if (others > 0)  // samples between the vertices: each stands for the same area
    std::ranges::fill(weights, 1.0);
  double sum = 0;
  for (const double weight : weights) sum += weight;
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

JudgedSamples judged_samples(const sim::Scene& scene, std::span<const double> weights, std::size_t most) {
  constexpr std::uint64_t seed = 1;
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

JudgedSamples judged_samples(const sim::Scene& scene, std::size_t most) {
  return judged_samples(scene, area_weights(scene), most);
}

}  // namespace detp::validate
