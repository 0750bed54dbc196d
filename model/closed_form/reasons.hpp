#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Detects predictions outside the range in which their formula was compared with counts.
///
/// The formulas were compared with counts (validate/sweep/results.md) for isotropic lines through S₀, samples uniform
/// in a cube or on its faces, n_P 10³ … 10⁷, d/r₀ 10⁻⁴ … 0.2, D 2 and 3, and the parameters below.
///
///     sphere-cache (both)   Q 0.3 … 0.9, k at most the published sphere_count, samples sorted
///     cell-spheres          depth 1 … 6
///     sphere-tree           fan-out 4 … 8, leaf 4 … 16
///     box-tree              n_P 2¹⁰ … 2²⁰, d 2⁻¹⁰ … 2³ sample distances and up to 0.16 of the side; fan-out 2 … 16,
///                           leaf 1 … 256
///     octree, grid          depth 1 … 7, 2 … 128 cells a side
///
/// Brute force always tests n_R n_P pairs, and so does a sphere cache without spheres: their counts are never
/// extrapolations.
namespace detp::model {

/// Collects reasons: a short text for each input that is outside its range.
class Reasons {
 public:
  /// Adds a reason unless least <= value <= most, except for rounding.
  void range(std::string_view what, double value, double least, double most);
  void add(std::string reason) { reasons_.push_back(std::move(reason)); }
  [[nodiscard]] std::vector<std::string> texts() && { return std::move(reasons_); }

 private:
  std::vector<std::string> reasons_;
};

/// Adds reasons that apply to every technique: workloads outside the sweep.
void uncounted_scene(const Valid<Workload>& workload, Reasons& reasons);

/// Adds a reason if the number of samples or the radius of the discs is outside the sweep of most techniques.
void range_of_samples(const Valid<Workload>& workload, Reasons& reasons);

/// Whether the workload is of the kind that was compared with counts: isotropic lines, samples uniform in a cube or on its
/// faces. Its numbers may be out of range.
[[nodiscard]] bool is_counted_scene(const Valid<Workload>& workload);

}  // namespace detp::model
