// Makes model/rebuild_law_tables.inc: how often the spheres of a cache are rebuilt along the Lebesgue curve.
//
//   cmake --build build --target rebuild_law_table && build/rebuild_law_table > model/rebuild_law_tables.inc
//
// Walks as the sphere cache does, with no rays: samples uniform in the cube [-1, 1]³ (D = 3) or on its faces (D = 2),
// sorted along the curve; a ball is centred at a sample and kept while the next samples lie within its radius ρ. It
// takes some minutes. Printed are, for D = 2 and then D = 3,
//   single   ln(m/n) of small balls: λ = 2⁻⁹ … 2¹², samples in a ball's cube n ρ^D/extent, by 16 phases of log₂(2/ρ)
//   coarse   ln(m) of large balls, for n = 10³ … 10⁷ samples by log₂(2/ρ) from -1 to 4 in steps of 1/16
//   chain    share of an outer ball's rebuilds that add to an inner one's, nested at the ratio q = 0.2 … 0.95, by 16
//            phases of the inner ball

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "detp/sim/lebesgue.hpp"
#include "detp/sim/uniform_discs.hpp"

namespace {

using namespace detp::sim;
using Points = std::vector<glm::dvec3>;

constexpr int phases = 16;
constexpr std::uint64_t seed = 20261121;

double extent_of(int dimension) { return dimension == 3 ? 8 : 24; }

Points sorted_samples(int dimension, std::size_t count, std::uint64_t set = seed) {
  Points points;
  points.reserve(count);
  for (const Disc& disc : uniform_discs(dimension == 3 ? Body::cube : Body::cube_faces, 2, count, 1, set))
    points.push_back(disc.centre);
  Points walk;
  walk.reserve(count);
  for (const std::uint32_t i : lebesgue_order(points)) walk.push_back(points[i]);
  return walk;
}

bool within(const glm::dvec3& a, const glm::dvec3& b, double radius) {
  return glm::dot(a - b, a - b) <= radius * radius;
}

double balls(const Points& walk, double radius) {
  double count = 0;
  const glm::dvec3* centre = nullptr;
  for (const glm::dvec3& point : walk) {
    if (centre != nullptr && within(point, *centre, radius)) continue;
    centre = &point;
    ++count;
  }
  return count;
}

/// ln(m/n): a ball of at most 1/8 of the cube's side, so that its faces matter little, and at least 2²⁰ samples.
double log_single(int dimension, double lambda, double phase) {
  double radius = 0.25 * std::exp2(-phase);
  const auto count = [&] { return lambda * extent_of(dimension) / std::pow(radius, dimension); };
  while (count() < 0x1p20) radius /= 2;
  const double samples = std::round(count());
  return std::log(balls(sorted_samples(dimension, static_cast<std::size_t>(samples)), radius) / samples);
}

void print_single() {
  for (const int dimension : {2, 3})
    for (int power = -9; power <= 12; ++power) {
      for (int phase = 0; phase < phases; ++phase)
        fmt::print("{:.3f},", log_single(dimension, std::exp2(power), phase / static_cast<double>(phases)));
      fmt::print("\n");
    }
}

/// ln of the mean count over sets of samples: the fewer the samples, the more sets.
double log_coarse(const std::vector<Points>& walks, double radius) {
  double sum = 0;
  for (const Points& walk : walks) sum += balls(walk, radius);
  return std::log(sum / static_cast<double>(walks.size()));
}

void print_coarse() {
  for (const int dimension : {2, 3})
    for (const std::size_t samples : {1'000UL, 10'000UL, 100'000UL, 1'000'000UL, 10'000'000UL}) {
      std::vector<Points> walks;
      for (std::size_t set = 0; set < std::clamp<std::size_t>(1'000'000 / samples, 1, 64); ++set)
        walks.push_back(sorted_samples(dimension, samples, seed + set));
      for (int step = -16; step <= 64; ++step)
        fmt::print("{:.3f},{}", log_coarse(walks, 2 * std::exp2(-step / 16.0)), step % 16 == 15 ? "\n" : "");
      fmt::print("\n");
    }
}

/// Rebuilds of all balls of a nest, from the outermost inwards.
std::vector<double> nested_balls(const Points& walk, const std::vector<double>& radii) {
  std::vector<double> count(radii.size());
  Points centres(radii.size(), walk.front());
  bool first = true;
  for (const glm::dvec3& point : walk) {
    std::size_t i = 0;
    if (!first)
      while (i < radii.size() && within(point, centres[i], radii[i])) ++i;
    for (; i < radii.size(); ++i) {
      centres[i] = point;
      ++count[i];
    }
    first = false;
  }
  return count;
}

/// Sums over the balls of many nests, by phase: what the outer rebuilds added, and the outer rebuilds.
struct Chain {
  std::array<double, phases> added{};
  std::array<double, phases> outer{};

  void add_nest(const Points& walk, double start, double ratio, double smallest) {
    std::vector<double> radii;
    for (double radius = start; radius >= smallest; radius *= ratio) radii.push_back(radius);
    const std::vector<double> nested = nested_balls(walk, radii);
    for (std::size_t i = 1; i < radii.size(); ++i) {
      if (radii[i] > 0.25) continue;  // the cube's own size shows
      const double halvings = std::log2(2 / radii[i]);
      const auto phase = static_cast<std::size_t>(phases * (halvings - std::floor(halvings))) % phases;
      const double alone = balls(walk, radii[i]);
      added[phase] += (nested[i] - alone) / (1 - nested[i] / static_cast<double>(walk.size())) / nested[i];
      outer[phase] += nested[i - 1] / nested[i];
    }
  }
};

void print_chain() {
  for (const int dimension : {2, 3}) {
    const Points walk = sorted_samples(dimension, 1'000'000);
    const double smallest = std::pow(8 * extent_of(dimension) / 1e6, 1.0 / dimension);  // 8 samples a ball
    for (const double ratio : {0.2, 0.3, 0.4, 0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95}) {
      Chain chain;
      for (int offset = 0; offset < phases; ++offset)
        chain.add_nest(walk, 1.2 * std::exp2(-(offset + 0.5) / phases), ratio, smallest);
      for (std::size_t phase = 0; phase < phases; ++phase)
        fmt::print("{:.3f},", chain.added[phase] / chain.outer[phase]);
      fmt::print("\n");
    }
  }
}

}  // namespace

int main() {
  fmt::print("// Made by validate/tables/rebuild_law_table.cpp.\n\n");
  fmt::print("constexpr std::array<double, 2 * single_rows * phases> single_table{{{{\n");
  print_single();
  fmt::print("}}}};\n\nconstexpr std::array<double, 2 * coarse_counts * coarse_steps> coarse_table{{{{\n");
  print_coarse();
  fmt::print("}}}};\n\nconstexpr std::array<double, 2 * chain_ratios.size() * phases> chain_table{{{{\n");
  print_chain();
  fmt::print("}}}};\n");
}
