// Makes model/box_tree_table.inc: how large the boxes of trees with fan-out 4 and 8, 16 or 64 samples a leaf are.
//
//   cmake --build build --target box_tree_table && build/box_tree_table > model/box_tree_table.inc
//   build/box_tree_table check
//
// Builds trees over samples uniform in a cube of side 1 (D = 3) or on its faces (D = 2), with no rays, in four minutes.
// Printed are log₂ of sums over all nodes but the root, for each leaf, for D = 2 and then D = 3: of 1; of the areas
// 4π r₀² P, times the number of children, 1, and the number of discs in a leaf; of the volumes, times the same; of each
// for n_P = two leaves, four leaves … 2²⁰ (rows) by d = 2⁻⁴ … 2⁶ sample distances (columns). `check` compares the
// closed form with other samples.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "detp/model/box_tree.hpp"
#include "detp/sim/random.hpp"
#include "detp/sim/uniform_discs.hpp"
#include "detp/validate/structural.hpp"
#include "detp/validate/structural_boxes.hpp"

namespace {

using namespace detp;

constexpr std::uint64_t seed = 20261122;
using Terms = std::array<double, 7>;

double distance_between(int dimension, double samples) {
  return dimension == 3 ? std::cbrt(1 / samples) : std::sqrt(6 / samples);
}

std::vector<sim::Disc> discs_of(int dimension, std::size_t samples, double distances, std::uint64_t set) {
  const double radius = distances * distance_between(dimension, static_cast<double>(samples));
  return sim::uniform_discs(dimension == 3 ? sim::Body::cube : sim::Body::cube_faces, 1, samples, radius, set);
}

Terms sums_of(const std::vector<sim::Disc>& discs, int leaf) {
  const sim::Ray ray{};
  const sim::Problem problem = sim::make_problem({&ray, 1}, discs);
  const sim::stream::Frame frame(problem);
  const auto tree = sim::stream::make_disc_tree(problem, frame, {model::box_tree_fan_out, leaf});
  const double outer = problem.enclosing.radius;
  const validate::BoxCrossing crossing(outer * frame.scale, frame.margin);
  Terms sums{};
  for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
    const sim::stream::TreeNode& node = tree.nodes[i];
    const double area = 4 * std::numbers::pi * outer * outer * crossing(node);
    const double volume = 8.0 * node.half[0] * node.half[1] * node.half[2] / std::pow(frame.scale, 3);
    const double count = node.count;
    const std::array weights{node.leaf ? 0 : count, 1.0, node.leaf ? count : 0};
    sums[0] += 1;
    for (std::size_t weight = 0; weight < 3; ++weight) {
      sums[1 + weight] += weights[weight] * area;
      sums[4 + weight] += weights[weight] * volume;
    }
  }
  return sums;
}

/// Means over enough sets of samples. Where a tree has no such nodes, next to nothing.
Terms mean_sums(int leaf, int dimension, std::size_t samples, double distances) {
  const std::size_t sets = std::clamp<std::size_t>((std::size_t{1} << 17) / samples, 2, 256);
  Terms mean{};
  for (std::uint64_t set = 0; set < sets; ++set) {
    const Terms sums = sums_of(discs_of(dimension, samples, distances, seed + set), leaf);
    for (std::size_t term = 0; term < mean.size(); ++term) mean[term] += sums[term] / static_cast<double>(sets);
  }
  for (double& term : mean) term = std::max(term, 0x1p-20);
  return mean;
}

void print_dimension(int leaf, int dimension) {
  std::vector<std::vector<Terms>> rows;
  for (std::size_t samples = 2 * static_cast<std::size_t>(leaf); samples <= std::size_t{1} << 20; samples *= 2) {
    rows.emplace_back();
    for (int column = -4; column <= 6; ++column)
      rows.back().push_back(mean_sums(leaf, dimension, samples, std::exp2(column)));
  }
  for (std::size_t term = 0; term < Terms{}.size(); ++term)
    for (const auto& row : rows) {
      for (const Terms& entry : row) fmt::print("{:.3f},", std::log2(entry[term]));
      fmt::print("\n");
    }
}

/// Deviations from the structural counts, per term: median, 95th percentile, worst.
void check_other_samples(int leaf) {
  constexpr std::array terms{&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests,
                             &Counts<double>::culls};
  const BoxTreeParameters parameters{model::box_tree_fan_out, leaf};
  std::array<std::vector<double>, terms.size()> deviations;
  for (std::uint64_t trial = 0; trial < 100; ++trial) {
    const auto number = sim::uniform4(seed, sim::Stream::tests, trial);
    const int dimension = trial % 2 == 0 ? 2 : 3;
    const auto samples = static_cast<std::size_t>(std::exp2(10 + 10 * number[0]));
    const double largest = 0.16 / distance_between(dimension, static_cast<double>(samples));  // of the scene's side
    const double distances = std::min(largest, std::exp2(-4 + 7 * number[1]));
    const double rays = std::exp2(10 + 10 * number[2]);
    const auto discs = discs_of(dimension, samples, distances, 2 * seed + trial);
    const Workload workload =
        cube_workload(std::round(rays), static_cast<double>(samples), discs.front().radius, 1, dimension);
    const auto expected = model::box_tree_counts(workload, parameters);
    const auto structural = validate::structural_counts(discs, std::round(rays), {Technique::box_tree, parameters});
    for (std::size_t term = 0; term < terms.size(); ++term)
      deviations[term].push_back(std::abs(expected.*terms[term] / structural.*terms[term] - 1));
  }
  fmt::print("{} samples a leaf\n", leaf);
  for (std::vector<double>& all : deviations) {
    std::sort(all.begin(), all.end());
    fmt::print("median {:.1f} %, 95th percentile {:.1f} %, worst {:.1f} %\n", 100 * all[all.size() / 2],
               100 * all[all.size() * 95 / 100], 100 * all.back());
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count > 1 && std::string_view(arguments[1]) == "check") {
    for (const int leaf : model::box_tree_leaves) check_other_samples(leaf);
    return 0;
  }
  fmt::print("// Made by validate/tables/box_tree_table.cpp.\n\n");
  fmt::print("constexpr std::array<double, 2 * terms * sample_steps * distance_steps> box_tree_table{{{{\n");
  for (const int leaf : model::box_tree_leaves)
    for (const int dimension : {2, 3}) print_dimension(leaf, dimension);
  fmt::print("}}}};\n");
}
