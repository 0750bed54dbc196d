#include "box_tree_leaf_costs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "box_tree_boxes.hpp"
#include "box_tree_crossing.hpp"
#include "box_tree_sah_leaves.hpp"
#include "detp/model/vocabulary/ray_blocks.hpp"

namespace detp::model {
namespace {

using box_tree::CellBoxes;
using box_tree::CellKind;
using box_tree::MeanBox;

double below(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }
double density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

/// The time saved by leaving nodes of one level whole.
class SplitCosts {
 public:
  SplitCosts(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, Engine engine)
      : cube_(workload), costs_(costs), rays_(workload.rays), blocks_(ray_blocks(rays_, workload.samples, engine)) {}

  [[nodiscard]] const box_tree::SampleCube& cube() const { return cube_; }

  /// The time with a node of `discs` discs split, minus that with a leaf, times the share of nodes that are split.
  [[nodiscard]] double of_node(const CellBoxes& whole, const CellBoxes& half, double discs, int smaller_leaf) const {
    const MeanBox box = whole(discs);
    const MeanBox half_box = half(discs / 2);
    const double p = cube_.crossing(box.surface, box.volume);
    const double p_half = cube_.crossing(half_box.surface, half_box.volume);
    const double p_top = std::min(1.0, p * p / p_half);
    const double again = 2 * below((discs / 2 - smaller_leaf - 0.5) / (std::sqrt(discs) / 2));  // halves split again
    const double lists = rays_ * (7 * p_top * costs_.cull_test + (12 * p_half - 5 * p) * costs_.listed) / 6 +
                         7 * blocks_.with_any(p_top) / 6 * costs_.cull + 2 * costs_.make;
    const double tests = rays_ * (p_half - p) * discs * costs_.disc_test;
    const double visits = (blocks_.with_any(p_half, half_box.spread) - blocks_.with_any(p, box.spread)) * discs;
    return split_share(box.products, half_box.products, discs) * ((1 + again) * lists + tests + visits * costs_.visit);
  }

 private:
  /// The share of nodes that the surface-area heuristic does not turn into leaves (box_tree_sah_leaves.hpp).
  static double split_share(double area, double half_area, double discs) {
    if (discs > box_tree::largest_sah_leaf) return 1;
    const double saved = (box_tree_split::cull - discs) * area + (2 * box_tree_split::list + discs) * half_area;
    return below(-saved / (0.2 * area * std::pow(discs, 0.7)));
  }

  box_tree::SampleCube cube_;
  const UnitCosts& costs_;
  double rays_;
  RayBlocks blocks_;
};

/// Adds the costs of splitting, times `weight`, for samples in a cube (dimension 3) or on its faces.
void add_splits(int dimension, double samples, const SplitCosts& split, Engine engine, double weight,
                std::array<double, searched_leaves.size()>& splits) {
  const auto& kinds = box_tree::cell_kinds(dimension, samples);
  const box_tree::Listing listing{engine, split.cube().margin()};
  for (const CellKind& kind : kinds) {
    const double expected = samples * kind.share;
    if ((dimension == 2 && kind.side[2] > 0) || expected > 1000 || kind.child[0] == 0) continue;
    if (expected < 1) break;
    const CellBoxes whole(kind, split.cube().ends(), listing);
    const CellBoxes half(kinds[kind.child[0]], split.cube().ends(), listing);
    const double deviation = std::sqrt(expected);
    for (std::size_t i = 0; i + 1 < searched_leaves.size(); ++i) {
      const double low = (searched_leaves[i] + 0.5 - expected) / deviation;
      const double high = (searched_leaves[i + 1] + 0.5 - expected) / deviation;
      if (low > 3.5 || high < -3.5) continue;
      const double between = below(high) - below(low);
      const double discs = std::clamp<double>(expected + deviation * (density(low) - density(high)) / between,
                                              searched_leaves[i] + 1, searched_leaves[i + 1]);
      const double parent_larger = below((expected + discs - searched_leaves[i + 1] - 0.5) / deviation);
      splits[i] +=
          weight / kind.share * between * parent_larger * split.of_node(whole, half, discs, searched_leaves[i]);
    }
  }
}

}  // namespace

std::array<double, searched_leaves.size()> rough_leaf_costs(const Valid<Workload>& workload,
                                                            const Valid<UnitCosts>& costs, Engine engine) {
  std::array<double, searched_leaves.size()> splits{};
  const SplitCosts split(workload, costs, engine);
  const double in_volume = std::clamp(workload.dimension - 2, 0.0, 1.0);
  if (in_volume < 1) add_splits(2, workload.samples, split, engine, 1 - in_volume, splits);
  if (in_volume > 0) add_splits(3, workload.samples, split, engine, in_volume, splits);
  for (std::size_t i = splits.size() - 1; i-- > 0;) splits[i] += splits[i + 1];
  return splits;
}

}  // namespace detp::model
