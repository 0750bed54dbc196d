// Makes model/hierarchy/sphere_tree_tables.inc: the sizes of the spheres around runs of samples along the Morton curve
// (the paper: Lebesgue curve).
//
//   cmake --build build --target sphere_tree_table && build/sphere_tree_table > model/hierarchy/sphere_tree_tables.inc
//
// Builds sphere trees, without rays, over discs of radius 0 at samples uniform in a cube of side 1 (D = 3) or on its
// faces (D = 2). Takes some minutes. Each table has values for D = 2, then for D = 3: first the squared mean, then the
// mean square of the spheres' radii ρ, both multiplied by N^{2/D}, where N is the number of spheres:
//   single   spheres around N runs of c = 2, 4, 8, 16, 32, 64, 256, 4096, 65536 samples each, by log₂N = 0, ¼, … 14
//   nested   spheres that enclose spheres, divided by the values of spheres around the samples of the same runs:
//            fan-out 2, 4, 8, 16, each 1, 2, 4 and 8 levels above the leaves, by log₂N = 0, ½, … 12
//
// If a tree would be too large, `nested` repeats the value of the row or column before. `single` uses the value of the
// row before, multiplied by the ratio of both rows in the last column that was computed.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "detp/sim/geometry/curve.hpp"
#include "detp/sim/lists/sphere_nodes.hpp"
#include "detp/sim/open/uniform_discs.hpp"

namespace {

using namespace detp;
using namespace detp::sim;

constexpr std::uint64_t seed = 20261121;
constexpr double most_samples = 0x1p20;
constexpr double no_radius = 1e-12;  // disc radius, almost 0

struct Samples {
  std::vector<Disc> discs;
  std::vector<std::uint32_t> order;
};

Samples samples_of(int dimension, std::size_t count, std::uint64_t set) {
  Samples samples{uniform_discs(dimension == 3 ? Body::cube : Body::cube_faces, 1, count, no_radius, seed + set), {}};
  std::vector<glm::dvec3> centres;
  for (const Disc& disc : samples.discs) centres.push_back(disc.centre);
  samples.order = lebesgue_order(centres);
  return samples;
}

/// Moments of the radii, scaled by N^{1/D}.
struct Moments {
  double mean = 0;
  double square = 0;
};

/// Moments of the radii of one level of a tree, averaged over several sets of samples. Each sphere is weighted by its
/// number of samples, because the last sphere may have fewer.
Moments radii(int dimension, double runs, std::size_t in_a_run, const SphereTreeParameters& tree, std::size_t level) {
  const auto count = static_cast<std::size_t>(std::round(runs * static_cast<double>(in_a_run)));
  const auto sets = static_cast<std::size_t>(std::clamp(0x1p19 / static_cast<double>(count), 2.0, 64.0));
  Moments sum;
  for (std::size_t set = 0; set < sets; ++set) {
    const Samples samples = samples_of(dimension, count, set);
    const SphereTree built = make_sphere_tree(samples.discs, samples.order, tree);
    const std::vector<Sphere>& spheres = built.levels.at(level);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const auto weight = static_cast<double>(std::min(in_a_run, count - i * in_a_run));
      sum.mean += weight * spheres[i].radius;
      sum.square += weight * spheres[i].radius * spheres[i].radius;
    }
  }
  const double scale = std::pow(runs, 1.0 / dimension);
  const auto weights = static_cast<double>(sets * count);
  return {scale * sum.mean / weights, scale * scale * sum.square / weights};
}

using Term = double (*)(const Moments&);
constexpr std::array<Term, 2> terms{[](const Moments& m) { return m.mean * m.mean; },
                                    [](const Moments& m) { return m.square; }};

void print(const std::vector<std::vector<Moments>>& rows, fmt::format_string<double> entry) {
  for (const Term term : terms)
    for (const auto& row : rows) {
      for (const Moments& moments : row) fmt::print(entry, term(moments));
      fmt::print("\n");
    }
}

void print_single(int dimension) {
  std::vector<std::vector<Moments>> rows;
  for (const std::size_t run : {2, 4, 8, 16, 32, 64, 256, 4096, 65536}) {
    std::vector<Moments> row;
    std::size_t last = 0;
    for (std::size_t step = 0; step <= 56; ++step) {
      const double runs = std::exp2(0.25 * static_cast<double>(step));
      if (runs * static_cast<double>(run) <= 4 * most_samples) {
        row.push_back(radii(dimension, runs, run, {1 << 20, static_cast<int>(run)}, 0));
        last = step;
      } else {
        const std::vector<Moments>& before = rows.back();
        row.push_back({before[step].mean * row[last].mean / before[last].mean,
                       before[step].square * row[last].square / before[last].square});
      }
    }
    rows.push_back(row);
  }
  print(rows, "{:.4f},");
}

/// Moments of a level's spheres, divided by those of spheres made directly around the samples of the same runs. Runs
/// have at least 64 samples.
std::vector<Moments> nested_row(int dimension, int fan_out, std::size_t level) {
  const auto spread = static_cast<std::size_t>(std::pow(fan_out, level));
  const std::size_t leaf = std::max<std::size_t>(2, 64 / spread);
  const std::size_t run = leaf * spread;
  std::vector<Moments> row;
  for (int step = 0; step <= 24; ++step) {
    const double runs = std::exp2(0.5 * step);
    if (step > 0 && runs * static_cast<double>(run) > most_samples) {
      row.push_back(row.back());
      continue;
    }
    const Moments above = radii(dimension, runs, run, {fan_out, static_cast<int>(leaf)}, level);
    const Moments alone = radii(dimension, runs, run, {1 << 20, static_cast<int>(run)}, 0);
    row.push_back({above.mean / alone.mean, above.square / alone.square});
  }
  return row;
}

void print_nested(int dimension) {
  std::vector<std::vector<Moments>> rows;
  for (const int fan_out : {2, 4, 8, 16})
    for (const std::size_t level : {1UL, 2UL, 4UL, 8UL})
      rows.push_back(std::pow(fan_out, level) > most_samples / 8 ? rows.back() : nested_row(dimension, fan_out, level));
  print(rows, "{:.3f},");
}

}  // namespace

int main() {
  fmt::print("// Made by validate/tools/sphere_tree_table.cpp.\n\n");
  fmt::print("constexpr std::array<double, 2 * 2 * single_runs.size() * single_steps> single_table{{{{\n");
  for (const int dimension : {2, 3}) print_single(dimension);
  fmt::print(
      "}}}};\n\nconstexpr std::array<double, 2 * 2 * nested_fan_outs * nested_levels * nested_steps> "
      "nested_table{{{{\n");
  for (const int dimension : {2, 3}) print_nested(dimension);
  fmt::print("}}}};\n");
}
