#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "all_effects.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t least_sampled = 8;  // sampled discs in a node that counts
constexpr int classes_an_octave = 2;

double surface_of(const glm::dvec3& side) { return 2 * (side.x * side.y + side.y * side.z + side.z * side.x); }

/// Half the extents of a disc of radius 1 along the axes.
glm::dvec3 extents_of(const Disc& disc) {
  return glm::sqrt(glm::max(glm::dvec3(0.0), 1.0 - disc.normal * disc.normal));
}

/// The box around the centres of some discs, and the largest half extents of such discs of radius 1 along each axis.
struct Extent {
  Box centres;
  glm::dvec3 discs{0.0};

  void include(const Disc& disc) {
    centres.include(disc.centre);
    discs = glm::max(discs, extents_of(disc));
  }
  void include(const Extent& other) {
    centres.include(other.centres.low);
    centres.include(other.centres.high);
    discs = glm::max(discs, other.discs);
  }
};

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

/// The tree that the builder of box trees makes of the sampled discs: it splits them where the curve leaves a cell.
class SampledNodes {
 public:
  explicit SampledNodes(const EffectSample& sample) : sample_(sample) {
    discs_a_place_ = static_cast<double>(sample.problem.discs().size()) / static_cast<double>(sample.places().size());
    whole_ = surface_of(sample.problem.centres().size());
    add_nodes(0, sample.places().size());
    const Class single = single_discs();
    if (single.nodes > 0) single_ = mean_of(single.sums, single.nodes);
  }

  /// Mean of the surfaces of the boxes around 8 to 15 sampled discs, over that of uniform samples; 1 if there are too few
  /// of them.
  [[nodiscard]] Finding ratio() const {
    constexpr double fewest = 8;
    if (counted_ < fewest) return {.value = 1};
    const double mean = sum_ / counted_;
    const double variance = std::max(0.0, squares_ / counted_ - mean * mean) * counted_ / (counted_ - 1);
    return {.value = mean, .standard_error = std::sqrt(variance / counted_)};
  }

  /// Means over the nodes with about the same number of samples, the largest first, single discs last.
  [[nodiscard]] std::vector<NodeBoxes> table() const {
    std::vector<NodeBoxes> all;
    for (auto one = classes_.rbegin(); one != classes_.rend(); ++one)
      if (one->nodes > 0) all.push_back(mean_of(one->sums, one->nodes));
    if (!all.empty()) all.push_back(single_);
    return all;
  }

 private:
  struct Class {
    double nodes = 0;
    NodeBoxes sums;
  };

  /// Adds the nodes of the places from `first` up to `end`, and returns their extent.
  Extent add_nodes(std::size_t first, std::size_t end) {
    Extent extent;
    if (end - first < least_sampled) {
      for (std::size_t i = first; i < end; ++i) extent.include(disc(i));
      return extent;
    }
    const std::size_t middle = first_of_second_half(first, end);
    extent = add_nodes(first, middle);
    extent.include(add_nodes(middle, end));
    count(extent, static_cast<double>(end - first));
    return extent;
  }

  [[nodiscard]] const Disc& disc(std::size_t place) const {
    return sample_.problem.discs()[sample_.places()[place].index];
  }

  [[nodiscard]] Class single_discs() const {
    Class single;
    for (std::size_t i = 0; i < sample_.places().size(); i += 8) {
      single.nodes += 1;
      add(single.sums, 1, glm::dvec3(0.0), extents_of(disc(i)));
    }
    return single;
  }

  [[nodiscard]] std::size_t first_of_second_half(std::size_t first, std::size_t end) const {
    const auto& places = sample_.places();
    const std::uint64_t last = places[end - 1].key;
    const std::uint64_t differ = places[first].key ^ last;
    if (differ == 0) return first + (end - first) / 2;
    const std::uint64_t start = last & ~(std::bit_floor(differ) - 1);
    const auto from = places.begin() + static_cast<std::ptrdiff_t>(first);
    const auto to = places.begin() + static_cast<std::ptrdiff_t>(end);
    const auto found = std::partition_point(from, to, [start](const KeyedIndex& place) { return place.key < start; });
    return static_cast<std::size_t>(found - places.begin());
  }

  /// m uniform points fill (m - 1)/(m + 1) of a side. The box of all samples is larger than that of the sampled ones by
  /// the ratio of these.
  void count(const Extent& extent, double sampled) {
    const double samples = sampled * discs_a_place_;
    const double grown = (samples - 1) / (samples + 1) * (sampled + 1) / (sampled - 1);
    const glm::dvec3 side = extent.centres.size() * grown;
    Class& one = classes_[static_cast<std::size_t>(classes_an_octave * std::log2(samples))];
    one.nodes += 1;
    add(one.sums, samples, side, extent.discs);
    if (sampled >= 2 * least_sampled || !(whole_ > 0)) return;
    const double share = sampled / static_cast<double>(sample_.places().size());
    const double filled = (samples - 1) / (samples + 1);
    const double uniform = filled * filled * uniform_surface(share, sample_.dimension().value);
    const double ratio = surface_of(side) / whole_ / uniform;
    counted_ += 1;
    sum_ += ratio;
    squares_ += ratio * ratio;
  }

  const EffectSample& sample_;
  double discs_a_place_;
  double whole_;
  std::array<Class, 33 * classes_an_octave> classes_;
  NodeBoxes single_;  ///< around one disc
  double counted_ = 0;
  double sum_ = 0;
  double squares_ = 0;
};

Finding find_clusters(const EffectSample& sample) {
  const SampledNodes nodes(sample);
  Finding finding = nodes.ratio();
  finding.apply = [table = nodes.table()](Workload& workload) { workload.nodes = table; };
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
