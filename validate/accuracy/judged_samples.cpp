#include "judged_samples.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

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

JudgedSamples judged_samples(const sim::Scene& scene, const Reference* reference, std::size_t most) {
  JudgedSamples judged;
  if (reference != nullptr) {
    judged.samples = reference->samples;
    judged.weights.assign(judged.samples.size(), 1 / static_cast<double>(judged.samples.size()));
    return judged;
  }
  const std::vector<double> weights = area_weights(scene);
  const std::size_t step = (weights.size() - 1) / most + 1;
  double sum = 0;
  for (std::size_t i = step / 2; i < weights.size(); i += step) {
    judged.places.push_back(i);
    judged.samples.push_back(scene.samples[i]);
    sum += judged.weights.emplace_back(weights[i]);
  }
  for (double& weight : judged.weights) weight /= sum;
  return judged;
}

}  // namespace detp::validate
