// Compares the closed form of the box tree (model/hierarchy/box_tree.hpp) with structural counts of random samples.
//
//   cmake --build build --target box_tree_accuracy && build/box_tree_accuracy [seed]
//
// Each tree has its own samples, uniform in a cube (D = 3) or on its faces (D = 2), and its own disc radius, fan-out,
// leaf size and number of rays, all drawn at random. Prints the deviations of the closed form from the counts of one
// set of samples, and from the mean counts over several sets with 2¹⁷ samples in total, since sets of few samples
// differ much.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/rank/predict.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/validate/structural/structural.hpp"

namespace {

using namespace detp;

constexpr std::array terms{&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests,
                           &Counts<double>::culls, &Counts<double>::visits};
constexpr std::array names{"box tests", "rays listed", "disc tests", "nodes visited", "discs visited"};

struct Tree {
  int dimension;
  std::size_t samples;
  double radius;
  double rays;
  BoxTreeParameters parameters;
};

/// n_P is from 2^least to 2^most.
Tree random_tree(std::uint64_t seed, std::uint64_t number, double least, double most) {
  const auto first = sim::uniform4(seed, sim::Stream::tests, number);
  const auto second = sim::uniform4(seed, sim::Stream::tests, number, 1);
  const int dimension = number % 2 == 0 ? 2 : 3;
  const auto samples = static_cast<std::size_t>(std::exp2(least + (most - least) * first[0]));
  const auto count = static_cast<double>(samples);
  const double between = dimension == 3 ? std::cbrt(1 / count) : std::sqrt(6 / count);
  const double largest_leaf = std::min(256.0, count / 2);
  return {dimension,
          samples,
          std::min(0.16, between * std::exp2(-10 + 13 * first[1])),
          std::round(std::exp2(10 + 14 * first[2])),
          {2 + static_cast<int>(15 * first[3]), static_cast<int>(std::round(std::pow(largest_leaf, second[0])))}};
}

Counts<double> structural(const Tree& tree, std::uint64_t set) {
  const sim::Body body = tree.dimension == 3 ? sim::Body::cube : sim::Body::cube_faces;
  const auto discs = sim::uniform_discs(body, 1, tree.samples, tree.radius, set);
  return validate::structural_counts(discs, tree.rays, {Technique::box_tree, tree.parameters});
}

void print(std::string_view name, std::vector<double> all) {
  std::sort(all.begin(), all.end());
  fmt::print("{:<28} median {:5.1f} %, 95th percentile {:5.1f} %, worst {:6.1f} %\n", name, 100 * all[all.size() / 2],
             100 * all[all.size() * 95 / 100], 100 * all.back());
}

void compare(std::uint64_t seed, std::uint64_t trees, double least, double most) {
  std::map<std::string, std::vector<double>> deviations;  // by what is compared
  double seconds = 0;
  for (std::uint64_t number = 0; number < trees; ++number) {
    const Tree tree = random_tree(seed, number, least, most);
    const auto samples = static_cast<double>(tree.samples);
    const Workload workload = cube_workload(tree.rays, samples, tree.radius, 1, tree.dimension);
    const auto start = std::chrono::steady_clock::now();
    const Counts<double> expected = model::predict(workload, {Technique::box_tree, tree.parameters});
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::size_t sets = std::clamp<std::size_t>((std::size_t{1} << 17) / tree.samples, 1, 256);
    Counts<double> sum;
    for (std::size_t set = 0; set < sets; ++set) {
      const Counts<double> counted = structural(tree, (seed << 32) + (number << 8) + set);
      for (std::size_t term = 0; term < terms.size(); ++term) {
        sum.*terms[term] += counted.*terms[term] / static_cast<double>(sets);
        if (set > 0) continue;
        const double deviation = std::abs(expected.*terms[term] / counted.*terms[term] - 1);
        deviations[fmt::format("{}, D = {}, one set", names[term], tree.dimension)].push_back(deviation);
        deviations[fmt::format("{}, both, one set", names[term])].push_back(deviation);
      }
    }
    for (std::size_t term = 0; term < terms.size(); ++term) {
      const double deviation = expected.*terms[term] / sum.*terms[term] - 1;
      deviations[fmt::format("{}, D = {}, mean", names[term], tree.dimension)].push_back(std::abs(deviation));
      if (std::abs(deviation) > 0.12)
        fmt::print("  {:+.1f} % of the mean {}: D = {}, {} samples, d {:.3g}, {} a node, {} a leaf\n", 100 * deviation,
                   names[term], tree.dimension, tree.samples, tree.radius, tree.parameters.fan_out,
                   tree.parameters.leaf);
    }
  }
  fmt::print("n_P 2^{} ... 2^{}, {} trees, {:.0f} us for each closed form\n", least, most, trees,
             1e6 * seconds / static_cast<double>(trees));
  for (const char* term : names)
    for (const char* sets : {"D = 2, one set", "D = 2, mean", "D = 3, one set", "D = 3, mean", "both, one set"}) {
      const std::string name = fmt::format("{}, {}", term, sets);
      print(name, deviations[name]);
    }
}

}  // namespace

int main(int count, char** arguments) {
  std::uint64_t seed = 1;
  if (count > 1) {
    const std::string_view text = arguments[1];
    std::from_chars(text.data(), text.data() + text.size(), seed);
  }
  compare(seed, 400, 10, 20);
  compare(seed, 200, 5, 10);
}
