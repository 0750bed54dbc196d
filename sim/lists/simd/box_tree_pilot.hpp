#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "binary_tree.hpp"
#include "block_search.hpp"
#include "detp/model/vocabulary/ray_blocks.hpp"
#include "pilot_counts.hpp"

/// Predicts the counts of any box tree over given discs and rays from a sample of both, without building the tree.
namespace detp::sim::stream {

/// The rays that a pilot culls, and the rays for which they stand.
struct PilotRays {
  std::span<const Ray> sample;
  double all;  ///< number of rays of the search
  /// The sample is not a part of the search's rays, but has the same distribution. Then all of it is uncertain, even if
  /// it has as many rays as the search.
  bool independent = false;
  /// Expected hits of the search, if they are known. Otherwise the sample's hits are counted.
  std::optional<double> hits = {};
};

/// A pilot culls a sample of the rays down a sample of the binary tree.
///
/// The top of the binary tree, down to subtrees of at most 512 discs, is built and culled whole. Of the subtrees, a few
/// are drawn with probabilities proportional to their expected work: one plus the sampled rays that cross them, times the
/// sum of the surfaces of the boxes below (those of at most 256 discs times the root of their number of discs), over the
/// surface of the subtree's box. They are built down to leaves of four discs and culled. Any box tree with leaves of at least four discs is made of nodes of the same binary tree, so its
/// counts are sums over these nodes:
///
///     count = n_R/n Σ_top rays(node) + n_R/n Σ_drawn w Σ_node rays(node)
///
///   where  n    number of sampled rays
///          w    number of subtrees for which a drawn subtree stands
///
/// The sums have no bias, except that wide nodes at the edge of subtrees that were not drawn may lack children. Lists
/// are made, and discs visited, if a block of rays has a ray there. The probability comes from the share of the sampled
/// rays in the list and, if there are few, from the surface of the box relative to the parent's.
///
/// Accuracy   visits in the mean over shapes and samples of 256 to 4096 rays, all subtrees culled: isotropic lines (3
///            scenes) 0 to 1 % off; photon paths 1 % too many on a mountain, 6 to 10 % in a hall, 20 to 28 % in a courtyard:
///            the estimate does not know that some discs are dark.
class BoxTreePilot {
 public:
  /// Draws up to `subtrees` subtrees. Throws as set_rays for the sample; Stopped if a stop was requested.
  BoxTreePilot(const Problem& problem, const Frame& frame, const SortedDiscs& discs, const PilotRays& rays,
               std::size_t subtrees, const std::stop_token& stop = {});

  /// Leaves of fewer than four discs are treated as leaves of four. Without `growth`, PilotCounts::at must not be called
  /// with another radius.
  [[nodiscard]] PilotCounts counts(const BoxTreeParameters& parameters, bool growth = false) const;

 private:
  /// What the pilot knows of a node of the binary tree.
  struct Known {
    float rays = 0;             ///< sampled rays in its list
    float blocks = 0;           ///< expected number of blocks of all rays that have a ray in its list
    float weight = 0;           ///< number of nodes for which it stands; 0: it was not culled
    std::uint32_t refined = 0;  ///< number of the root of its refined subtree; 0: none
  };
  struct Subtree {
    std::uint32_t root;       ///< in the coarse tree
    double work;              ///< in proportion to which subtrees are drawn
    double weight = 0;        ///< 0: not drawn
    std::uint32_t first = 0;  ///< its refined nodes are first … last - 1
    std::uint32_t last = 0;
    double tests = 0;  ///< of the sampled rays in its refined nodes
  };
  class Evaluation;  ///< box_tree_pilot_counts.cpp

  static constexpr std::uint32_t most_in_a_subtree = 512;
  static constexpr std::uint32_t finest_leaf = 4;

  std::uint32_t build_coarse(std::uint32_t first, std::uint32_t count);
  void cull_top(const BlockSearch& block, const RayLists& rays, Worker& worker);
  [[nodiscard]] RayLists cull_child(const BlockSearch& block, std::uint32_t child, const RayLists& lists, double weight,
                                    Worker& worker);
  void cull_top_below(const BlockSearch& block, std::uint32_t node, const RayLists& lists, Worker& worker);
  [[nodiscard]] double expected_work(std::uint32_t node) const;
  void draw_subtrees(std::size_t most);
  void refine(const BlockSearch& block, const RayLists& rays, Subtree& subtree, Worker& worker);
  void cull_refined(const BlockSearch& block, std::uint32_t node, const RayLists& lists, double weight, Worker& worker);
  template <class Visit>
  void for_each_culled_child(const Visit& visit) const;
  [[nodiscard]] double surface_share(std::uint32_t child, std::uint32_t parent) const;
  class Spread;
  void set_blocks();
  [[nodiscard]] double blocks_with_a_ray(std::uint32_t node, double shape) const;
  void set_relative_error();
  void set_radius();

  const SortedDiscs& discs_;
  double rays_;            ///< number of all rays
  double sampled_;         ///< number of rays in the sample
  bool segments_ = false;  ///< some sampled rays end
  double unseen_;          ///< share of the rays that the sample does not show
  RayBlocks blocks_;
  std::vector<BinaryNode> nodes_;  ///< the coarse tree, then the refined subtrees
  std::uint32_t coarse_ = 0;       ///< number of nodes of the coarse tree
  std::vector<Known> known_;
  std::vector<float> area_;    ///< of the nodes' boxes
  std::vector<double> share_;  ///< probability that a ray is in a node's list
  std::vector<Subtree> subtrees_;
  std::vector<float> work_;  ///< of each sampled ray: sum, over the subtrees that it crosses, of √(number of discs)
  double hits_ = 0;          ///< expected, of all rays
  double doubtful_ = 0;
  double relative_error_ = 0;
  float radius_ = 0;  ///< root mean square of a part of the discs
};

}  // namespace detp::sim::stream
