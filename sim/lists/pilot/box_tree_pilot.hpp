#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/ray_blocks.hpp"
#include "detp/sim/lists/simd/binary_tree.hpp"
#include "detp/sim/lists/simd/block_search.hpp"
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
  /// Rays from which a second sample may be drawn: all rays of the search in their order, or some of them, spread evenly.
  std::span<const Ray> others = {};
};

/// A node of the binary tree as a leaf of a tree: its box and its discs.
[[nodiscard]] TreeNode as_leaf(const BinaryNode& node);

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
/// Few sampled rays may reach many discs that lie close together. If the errors of such nodes of the top exceed a fifth of
/// the work, up to 64 times as many other rays are culled against these nodes, and those that cross them replace the
/// sample there (box_tree_pilot_again.cpp). Errors: box_tree_pilot_errors.cpp.
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
    float rays = 0;             ///< sampled rays in its list; those of a second sample divided by its precision
    float precision = 1;        ///< rays of the sample that was culled here, over those of the first sample
    float blocks = 0;           ///< expected number of blocks of all rays that have a ray in its list
    float guessed = 0;          ///< standard error of `blocks`: half of them where no sampled ray came
    float weight = 0;           ///< number of nodes for which it stands; 0: it was not culled
    std::uint32_t refined = 0;  ///< number of the root of its refined subtree; 0: none
  };
  static constexpr std::size_t groups = 32;
  using Groups = std::array<std::uint32_t, groups>;
  /// A count over the rays of a subtree's list, and the sum of the squared deviations of these rays from their mean.
  struct SumOverRays {
    double sum = 0;
    double squares = 0;
  };
  /// What a ray of the sample did in the subtree that is culled.
  struct OfRay {
    float disc_tests = 0;
    float hits = 0;
  };
  struct Subtree {
    std::uint32_t root;       ///< in the coarse tree
    double work = 0;          ///< in proportion to which subtrees are drawn
    double weight = 0;        ///< 0: not drawn
    std::uint32_t first = 0;  ///< its refined nodes are first … last - 1
    std::uint32_t last = 0;
    std::uint32_t sample = 0;     ///< number of the sample that is culled here
    Groups rays = {};             ///< sampled rays that cross it, by group
    SumOverRays disc_tests = {};  ///< in its smallest leaves
    SumOverRays hits = {};
    double expected_hits = 0;  ///< of the sampled rays that cross it
    double doubtful = 0;
  };
  /// Rays that were loaded: the first sample, or the rays of the second that cross a node of the top.
  struct Sample {
    BlockSearch block;
    RayLists lists;
    double precision = 1;                   ///< as Known::precision
    std::vector<std::uint32_t> group = {};  ///< of each ray; consecutive rays of the search are in the same group
    std::uint32_t root = 0;
  };
  /// A node of the top that few rays of the first sample reach, and the rays of the second that cross it.
  struct Region {
    std::uint32_t node;
    std::vector<Ray> rays = {};
    std::vector<std::uint32_t> group = {};
    std::optional<Problem> problem = {};
    RayLists lists = {};
    bool segments = false;
  };
  struct SecondSample {
    std::vector<Region> regions = {};
    double precision = 1;  ///< as Known::precision
  };
  /// Errors because a sample has few rays; the same for every shape.
  struct RayErrors {
    double tests = 0;  ///< relative variance of the sum over all rays
    double hits = 0;
    std::uint32_t node = 0;  ///< the node in which unseen rays may do most work
    double rays = 0;         ///< standard error of the number of rays that cross this node, where no sampled ray does
    double work = 0;         ///< expected work of these rays
    double unseen_hits = 0;  ///< expected hits of these rays
  };
  class Evaluation;  ///< box_tree_pilot_counts.cpp

  static constexpr std::uint32_t most_in_a_subtree = 512;
  static constexpr std::uint32_t finest_leaf = 4;

  std::uint32_t build_coarse(std::uint32_t first, std::uint32_t count);
  void set_expected_work();
  void find_subtrees(std::uint32_t node);
  void cull_top(const Sample& sample, std::uint32_t number, Worker& worker);
  [[nodiscard]] RayLists cull_child(const Sample& sample, std::uint32_t child, const RayLists& lists, double weight,
                                    Worker& worker);
  void cull_top_below(const Sample& sample, std::uint32_t number, std::uint32_t node, const RayLists& lists,
                      std::size_t& subtree, Worker& worker);
  [[nodiscard]] double work_of_a_ray(std::uint32_t node) const;
  [[nodiscard]] SecondSample plan_second_sample() const;
  void draw_second_sample(const Sample& first, std::span<const Ray> others, SecondSample& second, Worker& worker) const;
  void draw_subtrees(std::size_t most);
  void refine(const Sample& sample, Subtree& subtree, Worker& worker);
  void cull_refined(const Sample& sample, std::uint32_t node, const RayLists& lists, Subtree& subtree, Worker& worker);
  [[nodiscard]] double unseen(double precision) const;
  [[nodiscard]] double expected_hits_of_a_ray(std::uint32_t node) const;
  void set_hits();
  void set_ray_errors();
  void find_unseen();
  template <class Visit>
  void for_each_culled_child(const Visit& visit) const;
  [[nodiscard]] double surface_share(std::uint32_t child, std::uint32_t parent) const;
  [[nodiscard]] bool same_sample(std::uint32_t child, std::uint32_t parent) const {
    return known_[child].precision == known_[parent].precision;
  }
  /// Number of rays in a node's list, of the sample that was culled there.
  [[nodiscard]] double seen(std::uint32_t node) const { return known_[node].rays * known_[node].precision; }
  class Spread;
  void set_blocks();
  [[nodiscard]] double blocks_with_a_ray(std::uint32_t node, double shape) const;
  void set_radius();

  const SortedDiscs& discs_;
  double rays_;            ///< number of all rays
  double sampled_;         ///< number of rays in the sample
  bool segments_ = false;  ///< some sampled rays end
  bool independent_;       ///< PilotRays::independent
  RayBlocks blocks_;
  std::vector<BinaryNode> nodes_;  ///< the coarse tree, then the refined subtrees
  std::uint32_t coarse_ = 0;       ///< number of nodes of the coarse tree
  std::vector<Known> known_;
  std::vector<float> area_;    ///< of the nodes' boxes
  std::vector<double> share_;  ///< probability that a ray is in a node's list
  std::vector<Subtree> subtrees_;
  std::vector<double> work_;   ///< expected below a coarse node for a ray that crosses it, times the area of its box
  std::vector<OfRay> of_ray_;  ///< by number in the sample; all 0 between subtrees
  std::optional<double> given_hits_;
  RayErrors ray_errors_;
  double hits_ = 0;        ///< expected, of the sampled rays
  double hits_ratio_ = 0;  ///< hits over Subtree::expected_hits where not all subtrees were drawn
  float radius_ = 0;       ///< root mean square of a part of the discs
};

}  // namespace detp::sim::stream
