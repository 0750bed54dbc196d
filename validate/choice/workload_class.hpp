#pragma once

#include <compare>
#include <span>
#include <stop_token>
#include <string>

#include "detp/model/vocabulary/valid.hpp"
#include "detp/model/vocabulary/workload.hpp"
#include "detp/sim/effects/observe.hpp"

namespace detp::sim {
class Problem;
struct Ray;
}  // namespace detp::sim

namespace detp::validate {

/// Workloads so much alike that a choice for one serves the others: rounded logarithms of what a choice depends on.
struct WorkloadClass {
  int rays = 0;         ///< log₂ n_R
  int discs = 0;        ///< log₂ n_P
  int spacing = 0;      ///< 2 log₂ X, X being the distance between neighbouring samples over d
  int dimension = 0;    ///< 4 D, D being the dimension of the samples
  int path_length = 0;  ///< log₂ of the mean length of the rays over the scene's longest side; `lines` for lines
  bool front_facing = false;

  static constexpr int lines = 99;

  auto operator<=>(const WorkloadClass&) const = default;
};

[[nodiscard]] WorkloadClass class_of(const Valid<Workload>& workload);

/// The class in words: "about 65536 rays, 8192 discs, X = 1, D = 2, lines".
[[nodiscard]] std::string describe(const WorkloadClass& workload);

/// The workload of `rays` rays like the given ones, and the problem's discs. Cheap: measured on at most 8192 of the discs
/// and 1024 of the rays, so less accurate than `measure`. It has the selected effects. Throws std::invalid_argument for a ray that is malformed,
/// sim::Stopped on a stop request.
[[nodiscard]] Workload sampled_workload(const sim::Problem& problem, std::span<const sim::Ray> like, double rays,
                                        const sim::EffectSelection& effects = {}, const std::stop_token& stop = {});

}  // namespace detp::validate
