#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string_view>
#include <utility>
#include <vector>

#include "crossings.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/search/problem.hpp"
#include "paths_inside.hpp"
#include "sample_dimension.hpp"
#include "sampled_tree.hpp"

namespace detp::sim {

/// Measured evidence.
struct Finding {
  double value = 0;
  double standard_error = 0;  ///< of the value; 0 if it is computed from all rays and discs
  /// Sets what predictions take from the effect. Called only if the effect is on.
  std::function<void(Workload&)> apply = [](Workload&) {};
};

/// Properties of the scene from which discs and rays come; zeros without one.
struct SurfaceFacts {
  double area = 0;                          ///< of all triangles
  double edge_length = 0;                   ///< mean
  std::optional<Finding> self_shadow = {};  ///< self_shadow.hpp; only if photon paths are made
  double piece_seconds = 0;                 ///< to trace a piece of a path on one thread; 0: not known
};

/// How much of rays and discs is looked at, at most.
struct EvidenceEffort {
  std::size_t discs = 1U << 13;         ///< sampled
  std::size_t rays = 1U << 11;          ///< whose lengths are measured
  std::size_t crossing_rays = 1U << 9;  ///< of which it is counted how many samples they pass

  /// The effort that takes about 0.5 % of the time of a search with so many rays and discs, or a fifth of the default if that is more; at most the
  /// default, which takes 0.7 to 1.2 ms. Rough: the search takes 60 ns for each disc and 150 ns for each ray.
  [[nodiscard]] static EvidenceEffort for_search(double rays, double discs);
};

/// Whether evidence can pay for one search with so many rays and discs: a search of 30 ms or more, by the rough times of
/// EvidenceEffort::for_search. On ordinary scenes, choices by closed forms lose nothing without effects (notebooks-data/studies/effects).
[[nodiscard]] bool evidence_can_pay(double rays, double discs);

/// What effects are looked for in, and what they share of it. Everything is measured on first use; not for use from
/// several threads. It refers to the problem, which must outlive it. Every function throws Stopped if a stop was
/// requested.
class EffectSample {
 public:
  EffectSample(const Problem& of, const SurfaceFacts& mesh, const EvidenceEffort& most, std::stop_token stop_token)
      : problem(of), surface(mesh), effort(most), stop(std::move(stop_token)) {}

  const Problem& problem;
  const SurfaceFacts surface;
  const EvidenceEffort effort;
  const std::stop_token stop;

  /// Stratified.
  [[nodiscard]] const std::vector<std::size_t>& rays() const;
  /// Stratified. The unit is r₀, the origin the centre of S₀.
  [[nodiscard]] const CurveSample& discs() const;
  /// Of these discs.
  [[nodiscard]] const SampleDimension& dimension() const;
  [[nodiscard]] const std::vector<SampledNode>& tree() const;
  /// Of the rays; zeros if all are lines.
  [[nodiscard]] const PathsInside& paths() const;
  /// Uniform rays with the mean length of the rays.
  [[nodiscard]] const UniformRays& uniform() const;
  [[nodiscard]] const Crossings& crossings() const;

 private:
  template <class T, class F>
  static const T& once(std::optional<T>& value, const F& measure) {
    if (!value) value = measure();
    return *value;
  }

  mutable std::optional<std::vector<std::size_t>> rays_;
  mutable std::optional<CurveSample> discs_;
  mutable std::optional<SampleDimension> dimension_;
  mutable std::optional<std::vector<SampledNode>> tree_;
  mutable std::optional<PathsInside> paths_;
  mutable std::optional<UniformRays> uniform_;
  mutable std::optional<Crossings> crossings_;
};

/// The values of an evidence with which its effect is on.
struct Threshold {
  enum class Side {
    above,  ///< greater than `at`
    below,  ///< less than `at`
    apart   ///< farther than `tolerance` from `at`
  };
  Side side = Side::above;
  double at = 0;
  double tolerance = 0;

  [[nodiscard]] bool passed(double value) const;
  /// Distance from the value to the nearest value at which the effect would be switched.
  [[nodiscard]] double distance(double value) const;
  /// How far the value is on the way to the threshold: 1 at it, more where the effect would be on. Of `below`: threshold over value. 0
  /// for values that no ratio can be made of.
  [[nodiscard]] double over(double value) const;
};

/// A way in which rays and discs deviate from the assumptions of the models.
struct Effect {
  std::string_view name;      ///< "finite paths"; in options with hyphens
  std::string_view evidence;  ///< what the value is
  Threshold threshold;
  /// A meaning of the input, not an approximation: nobody can switch it. It is on if the input says so.
  bool is_input = false;
  Finding (*find)(const EffectSample&);
  /// The value for a workload that is given by numbers.
  double (*of_numbers)(const Workload&);
};

}  // namespace detp::sim
