#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "all_effects.hpp"

namespace detp::sim {
namespace {

constexpr int classes_an_octave = 2;
constexpr std::size_t most_small = 16;  // small nodes have fewer sampled discs

double surface_of(const glm::dvec3& side) { return 2 * (side.x * side.y + side.y * side.z + side.z * side.x); }

/// Adds the box of sides `side` + 2d `half`.
void add(NodeBoxes& sums, double samples, const glm::dvec3& side, const glm::dvec3& half) {
  const auto pairs = [](const glm::dvec3& a, const glm::dvec3& b) {  // a_x b_y + a_y b_x + …
    return a.x * (b.y + b.z) + a.y * (b.z + b.x) + a.z * (b.x + b.y);
  };
  const auto threes = [](const glm::dvec3& a, const glm::dvec3& b) {  // a_x b_y b_z + …
    return a.x * b.y * b.z + a.y * b.z * b.x + a.z * b.x * b.y;
  };
  const glm::dvec3 grown = 2.0 * half;
  sums.samples += samples;
  sums.edges += side.x + side.y + side.z;
  sums.surface[0] += surface_of(side);
  sums.surface[1] += 2 * pairs(side, grown);
  sums.surface[2] += surface_of(grown);
  sums.squares[0] += glm::dot(side, side);
  sums.squares[1] += 2 * glm::dot(side, grown);
  sums.squares[2] += glm::dot(grown, grown);
  sums.volume[0] += side.x * side.y * side.z;
  sums.volume[1] += threes(grown, side);
  sums.volume[2] += threes(side, grown);
  sums.volume[3] += grown.x * grown.y * grown.z;
}

NodeBoxes mean_of(NodeBoxes sums, double nodes) {
  sums.samples /= nodes;
  sums.edges /= nodes;
  for (double& one : sums.surface) one /= nodes;
  for (double& one : sums.squares) one /= nodes;
  for (double& one : sums.volume) one /= nodes;
  return sums;
}

/// The surface of a box around a share of the samples, over that of the box around all, if the samples are uniform: in a
/// volume share^(2/3), on surfaces 2 share (both faces of a flat patch, over the area of all, which is about the surface
/// of their box), between in proportion.
double uniform_surface(double share, double dimension) {
  const double weight = std::clamp(dimension - 2, 0.0, 1.0);
  return std::pow(share, 2 * weight / 3) * std::pow(2 * share, 1 - weight);
}

/// Sides of the box around all samples of a node. m uniform points fill (m - 1)/(m + 1) of a side, so the box is larger
/// than that of the sampled ones.
class NodeSides {
 public:
  explicit NodeSides(const EffectSample& sample)
      : unit_(sample.discs().unit),
        discs_a_place_(static_cast<double>(sample.problem.discs().size()) /
                       static_cast<double>(sample.discs().discs.size())) {}

  /// The number of samples for each sampled one.
  [[nodiscard]] double discs_a_place() const { return discs_a_place_; }

  [[nodiscard]] glm::dvec3 of(const SampledNode& node) const {
    const double sampled = node.size();
    const double samples = sampled * discs_a_place_;
    const double grown = (samples - 1) / (samples + 1) * (sampled + 1) / (sampled - 1);
    return glm::dvec3(node.high - node.low) * (grown * unit_);
  }

 private:
  double unit_;
  double discs_a_place_;
};

/// Half extents of the box around discs of radius 1.
glm::dvec3 half_extents(const SampledNode& node) {
  const glm::dvec3 flattest(node.flattest);
  return glm::sqrt(glm::max(glm::dvec3(0.0), 1.0 - flattest * flattest));
}

/// Mean of the surfaces of the boxes around 8 to 15 sampled discs, over that of uniform samples; 1 if there are too few
/// of them.
Finding ratio_of_surfaces(const EffectSample& sample) {
  constexpr double fewest = 8;
  const NodeSides sides(sample);
  const auto& nodes = sample.tree();
  const double whole = surface_of(sample.problem.centres().size());
  const auto places = static_cast<double>(sample.discs().discs.size());
  std::array<double, most_small> uniform{};  // by the number of sampled discs
  for (std::size_t sampled = least_split; sampled < uniform.size(); ++sampled) {
    const double samples = static_cast<double>(sampled) * sides.discs_a_place();
    const double filled = (samples - 1) / (samples + 1);
    uniform[sampled] =
        filled * filled * whole * uniform_surface(static_cast<double>(sampled) / places, sample.dimension().value);
  }
  double counted = 0;
  double sum = 0;
  double squares = 0;
  for (const SampledNode& node : nodes) {
    if (node.size() < least_split || node.size() >= most_small) continue;
    const double ratio = surface_of(sides.of(node)) / uniform[node.size()];
    counted += 1;
    sum += ratio;
    squares += ratio * ratio;
  }
  if (counted < fewest || !(whole > 0)) return {.value = 1};
  const double mean = sum / counted;
  const double variance = std::max(0.0, squares / counted - mean * mean) * counted / (counted - 1);
  return {.value = mean, .standard_error = std::sqrt(variance / counted)};
}

/// Means over the nodes with about the same number of samples, the largest first, single discs last. None if there are
/// too few sampled discs.
std::vector<NodeBoxes> mean_boxes(const EffectSample& sample) {
  struct Class {
    double nodes = 0;
    NodeBoxes sums;
  };
  const NodeSides sides(sample);
  std::array<Class, 33 * classes_an_octave> classes;
  for (const SampledNode& node : sample.tree()) {
    if (node.size() < least_split) continue;
    const double samples = node.size() * sides.discs_a_place();
    Class& one = classes[static_cast<std::size_t>(classes_an_octave * std::log2(samples))];
    one.nodes += 1;
    add(one.sums, samples, sides.of(node), half_extents(node));
  }
  std::vector<NodeBoxes> all;
  for (auto one = classes.rbegin(); one != classes.rend(); ++one)
    if (one->nodes > 0) all.push_back(mean_of(one->sums, one->nodes));
  if (all.empty()) return all;
  Class single;
  for (std::size_t i = 0; i < sample.discs().discs.size(); i += 8) {
    const glm::dvec3 normal(sample.discs().discs[i].steepness);
    single.nodes += 1;
    add(single.sums, 1, glm::dvec3(0.0), glm::sqrt(glm::max(glm::dvec3(0.0), 1.0 - normal * normal)));
  }
  all.push_back(mean_of(single.sums, single.nodes));
  return all;
}

Finding find_clusters(const EffectSample& sample) {
  Finding finding = ratio_of_surfaces(sample);
  finding.apply = [&sample](Workload& workload) { workload.nodes = mean_boxes(sample); };
  return finding;
}

double clusters_of_numbers(const Workload&) { return 1; }

}  // namespace

constinit const Effect clustered_samples{
    .name = "clustered samples",
    .evidence = "surface of small boxes around samples, over that of uniform samples",
    .threshold = {Threshold::Side::apart, 1, 0.15},
    .find = find_clusters,
    .of_numbers = clusters_of_numbers};

}  // namespace detp::sim
