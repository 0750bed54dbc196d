// Makes model/rebuild_law_table.inc: how often a single ball is rebuilt along the Lebesgue curve.
//
//   cmake --build build --target rebuild_law_table && build/rebuild_law_table > model/rebuild_law_table.inc
//
// The walk of one sphere of the cache, with no rays: samples uniform in the cube [-1, 1]³ (D = 3) or on its faces
// (D = 2), sorted; the ball is centred at a sample and kept while the next samples lie within its radius ρ. Printed is
// ln(m/n), m the number of balls, n that of samples, against λ (samples per ball of ρ: n ρ^D / extent) and the phase of
// ρ between two halvings of the cube. It takes some minutes.

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "detp/sim/lebesgue.hpp"
#include "detp/sim/random.hpp"

namespace {

using namespace detp::sim;

glm::dvec3 point_in_cube(std::uint64_t i, std::uint64_t seed) {
  const auto u = uniform4(seed, Stream::samples, i);
  return {2 * u[0] - 1, 2 * u[1] - 1, 2 * u[2] - 1};
}

glm::dvec3 point_on_faces(std::uint64_t i, std::uint64_t seed) {
  const auto u = uniform4(seed, Stream::samples, i);
  glm::dvec3 point = {2 * u[0] - 1, 2 * u[1] - 1, 2 * u[2] - 1};
  const int face = static_cast<int>(6 * u[3]);
  point[face / 2] = face % 2 == 0 ? -1 : 1;
  return point;
}

double rebuilds(const std::vector<glm::dvec3>& walk, double radius) {
  double count = 0;
  const glm::dvec3* centre = nullptr;
  for (const glm::dvec3& point : walk) {
    if (centre != nullptr && glm::dot(point - *centre, point - *centre) <= radius * radius) continue;
    centre = &point;
    ++count;
  }
  return count;
}

std::vector<glm::dvec3> sorted_samples(int dimension, std::size_t count, std::uint64_t seed) {
  std::vector<glm::dvec3> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = dimension == 3 ? point_in_cube(i, seed) : point_on_faces(i, seed);
  std::vector<glm::dvec3> walk;
  walk.reserve(count);
  for (const std::uint32_t i : lebesgue_order(points)) walk.push_back(points[i]);
  return walk;
}

/// ln(m/n): a ball of at most 1/8 of the cube's side, so that its faces matter little, and at least 2²⁰ samples.
double log_rebuild_share(int dimension, double lambda, double phase) {
  const double extent = dimension == 3 ? 8 : 24;
  double radius = 0.25 * std::exp2(-phase);
  double count = lambda * extent / std::pow(radius, dimension);
  for (; count < 0x1p20; radius /= 2) count *= std::exp2(dimension);
  count = std::round(lambda * extent / std::pow(radius, dimension));
  return std::log(rebuilds(sorted_samples(dimension, static_cast<std::size_t>(count), 20261121), radius) / count);
}

}  // namespace

int main() {
  for (const int dimension : {2, 3}) {
    fmt::print("// D = {}\n", dimension);
    for (int power = -9; power <= 12; ++power) {
      for (int eighth = 0; eighth < 8; ++eighth)
        fmt::print("{:.4f}, ", log_rebuild_share(dimension, std::exp2(power), eighth / 8.0));
      fmt::print(" // lambda = 2^{}\n", power);
      std::fflush(stdout);
    }
  }
}
