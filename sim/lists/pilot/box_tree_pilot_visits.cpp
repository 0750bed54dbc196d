#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "box_tree_pilot.hpp"

/// How many blocks of rays have a ray in each list of a box tree.
namespace detp::sim::stream {

/// Calls visit(child, parent) for all nodes that were culled, parents before their children.
template <class Visit>
void BoxTreePilot::for_each_culled_child(const Visit& visit) const {
  const auto both = [&](std::uint32_t parent) {
    visit(parent + 1, parent);
    visit(nodes_[parent].right, parent);
  };
  for (std::uint32_t node = 0; node < coarse_; ++node)
    if (nodes_[node].count > most_in_a_subtree) both(node);
  for (const Subtree& subtree : subtrees_)
    for (std::uint32_t node = subtree.first; node < subtree.last; ++node)
      if (!nodes_[node].leaf()) both(node);
}

double BoxTreePilot::surface_share(std::uint32_t child, std::uint32_t parent) const {
  return std::min(1.0F, area_[child] / area_[parent]);
}

/// How the rays of lists go on to the children: f and s (see set_blocks), for classes of lists by their number of sampled
/// rays. A class with too few lists has those of the next class with more rays, or if there is none, with fewer.
class BoxTreePilot::Spread {
 public:
  explicit Spread(const BoxTreePilot& pilot) : pilot_(pilot) {
    pilot.for_each_culled_child([&](std::uint32_t child, std::uint32_t parent) {
      if (!pilot.same_sample(child, parent)) return;
      Class& one = class_of(parent);
      one.children += 1;
      one.reached += pilot.known_[child].rays;
      one.by_surface += pilot.known_[parent].rays * pilot.surface_share(child, parent);
    });
    for (Class& one : classes_)
      if (one.by_surface > 0) one.factor = one.reached / one.by_surface;
    pilot.for_each_culled_child([&](std::uint32_t child, std::uint32_t parent) {
      if (!pilot.same_sample(child, parent)) return;
      const double rays = pilot.seen(parent);
      const double share = expected_share(child, parent);
      const double variance = rays * share * (1 - share);
      Class& one = class_of(parent);
      one.squares += std::pow(pilot.seen(child) - rays * share, 2);
      one.independent += variance;
      one.pairs += (rays - 1) * variance;
    });
    const Class* known = nullptr;
    for (Class& one : classes_)
      if (one.is_known()) known = &one;
    for (std::size_t i = classes_.size(); known != nullptr && i-- > 0;) {
      Class& one = classes_[i];
      if (!one.is_known()) {
        one = *known;
        continue;
      }
      known = &one;
      one.strength = 1 / std::clamp((one.squares - one.independent) / one.pairs, 0.001, 0.8) - 1;
    }
  }

  /// f q
  [[nodiscard]] double expected_share(std::uint32_t child, std::uint32_t parent) const {
    return std::min(1.0, class_of(parent).factor * pilot_.surface_share(child, parent));
  }
  /// s
  [[nodiscard]] double strength(std::uint32_t parent) const { return class_of(parent).strength; }

 private:
  struct Class {
    double factor = 1;
    double strength = 1;
    double children = 0;
    double reached = 0;
    double by_surface = 0;
    double squares = 0;      ///< of the deviations from the expected numbers of rays
    double independent = 0;  ///< their expectation if the rays were independent
    double pairs = 0;        ///< of rays of a list, times the variance for one ray
    [[nodiscard]] bool is_known() const { return children >= 40 && pairs > 0; }
  };

  static std::size_t place_of(float rays) {
    constexpr std::array<float, 4> bounds{8, 32, 128, 512};
    return static_cast<std::size_t>(std::upper_bound(bounds.begin(), bounds.end(), rays) - bounds.begin());
  }
  [[nodiscard]] const Class& class_of(std::uint32_t parent) const {
    return classes_[place_of(pilot_.known_[parent].rays)];
  }
  [[nodiscard]] Class& class_of(std::uint32_t parent) { return classes_[place_of(pilot_.known_[parent].rays)]; }

  const BoxTreePilot& pilot_;
  std::array<Class, 5> classes_;
};

/// Sets the share of all rays in each list, and the expected number of blocks that have a ray there.
///
/// Of a parent's n rays, c reach a child: a beta-binomial variable. Its mean is f n q, where q is the child's surface
/// relative to the parent's and f makes the sums of both sides equal. Its variance exceeds that of independent rays by
/// 1 + (n - 1)/(s + 1). So s is large if rays are spread evenly, and small if they are bundled. Then the expected share
/// of the parent's rays, given c, is (c + s f q)/(n + s). Light is more even within a small box than in the whole scene,
/// so f and s are those of parents with about the same number of rays.
///
/// Where a second sample begins, the share is that of its rays, plus half a ray.
void BoxTreePilot::set_blocks() {
  const Spread spread(*this);
  std::vector<float> shape(nodes_.size());  // of the gamma distribution of a node's share
  const auto pass_on_to_refined = [&](std::uint32_t node) {
    const std::uint32_t refined = known_[node].refined;
    if (refined == 0) return;
    known_[refined].blocks = known_[node].blocks;
    known_[refined].guessed = known_[node].guessed;
    share_[refined] = share_[node];
    shape[refined] = shape[node];
  };
  shape[0] = known_[0].rays;
  pass_on_to_refined(0);
  for_each_culled_child([&](std::uint32_t child, std::uint32_t parent) {
    const double rays = seen(child);
    double prior = 0.5;
    if (same_sample(child, parent)) {
      const double strength = spread.strength(parent);
      prior = strength * spread.expected_share(child, parent);
      share_[child] = share_[parent] * (rays + prior) / (seen(parent) + strength);
    } else {
      share_[child] = (rays + prior) / (known_[child].precision * sampled_);
    }
    shape[child] = static_cast<float>(rays > 0 ? rays + prior : 1 / (1 / prior + 1 / (shape[parent] + 1e-3)));
    Known& known = known_[child];
    known.blocks = static_cast<float>(blocks_with_a_ray(child, shape[child]));
    known.guessed = known.blocks < blocks_.count() ? 0.5F * known.blocks / static_cast<float>(1 + rays) : 0;
    pass_on_to_refined(child);
  });
}

double BoxTreePilot::blocks_with_a_ray(std::uint32_t node, double shape) const {
  constexpr double many = 16;           // sampled rays; then every block has some
  constexpr double least_shape = 1e-6;  // practically no block has one
  const Known& known = known_[node];
  const bool all_seen = unseen(known.precision) == 0;
  if (all_seen && known.rays == 0) return 0;
  if ((all_seen && blocks_.count() == 1) || known.rays > many) return blocks_.count();
  // The rays of a block in the list are a Poisson variable, whose mean is a gamma variable of that shape.
  const auto any = [&](double rays) {
    const auto power = static_cast<float>(std::max(shape, least_shape));
    return 1 - std::exp(-power * std::log(1 + static_cast<float>(rays * share_[node]) / power));
  };
  return blocks_.whole * any(blocks_.size) + (blocks_.last > 0 ? any(blocks_.last) : 0);
}

}  // namespace detp::sim::stream
