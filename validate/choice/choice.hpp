#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/search/index.hpp"
#include "detp/sim/search/problem.hpp"

namespace detp::sim {
class PilotedDiscs;
}  // namespace detp::sim

/// Who decides: one question, one answer.
namespace detp::validate {

/// What a choice is for.
enum class Purpose {
  prediction,  ///< the time of the choice, too
  one_search,  ///< the choice alone, for one search: a pilot of a short one would take longer than it saves
  replans      ///< many searches, also with discs of other radii: Prediction::counts_at
};

/// What is to be searched, and what is allowed.
struct Question {
  /// The discs, and perhaps the rays. Null: only the workload is known.
  const sim::Problem* problem = nullptr;
  /// Some or all rays of the search; default: those of the problem.
  std::span<const sim::Ray> rays = {};
  /// Number of rays of the search; default: of `rays`, or else that of the workload.
  std::optional<double> ray_count = {};
  /// For closed forms; default: measured on discs and rays, with `effects`, if it is needed.
  std::optional<Workload> workload = {};
  sim::EffectSelection effects = {};
  const sim::SurfaceFacts* surface = nullptr;  ///< of the discs' scene; null: not known
  /// estimate, structural or pilot; default: reachable_rigor
  std::optional<Rigor> rigor = {};
  Purpose purpose = Purpose::prediction;
  int threads = 1;                       ///< most threads, for choosing and for the choice; 0: all cores
  std::vector<Technique> disabled = {};  ///< techniques that may not be chosen
  std::stop_token stop = {};

  [[nodiscard]] bool allows(Technique technique) const;
};

/// A technique that was not tried, because the unit costs say that it is slower than the choice.
struct RuledOut {
  Technique technique;
  double seconds;  ///< by_bound: the least that it could take; otherwise, by its closed form
  bool by_bound;
};

struct Choice {
  std::vector<Prediction> candidates;  ///< the choice first, then the others in the order of their time
  Rigor rigor = Rigor::estimate;       ///< reached
  std::vector<RuledOut> ruled_out = {};
  std::vector<Technique> unexamined = {};  ///< could still win, but finding out would take longer than it could save
  double sort_seconds = 0;                 ///< for sorting the discs, which the run needs anyway
  double choosing_seconds = 0;             ///< for everything else
  std::size_t sampled_rays = 0;
  std::shared_ptr<sim::PilotedDiscs> discs = {};  ///< kept for the run; null if there was no pilot

  [[nodiscard]] const Prediction& best() const { return candidates.front(); }
};

/// pilot, if there are rays, and float kernels can search them (the engine is simd, and no ray starts too far away), and
/// box-tree is allowed; else estimate.
[[nodiscard]] Rigor reachable_rigor(const Question& question, const CostTable& costs);

/// The exact technique, with parameters and number of threads, that finds the hits fastest, and how long it takes. All
/// choices of the command and of plans are made here.
///
///     estimate     closed forms alone (allowed_ranking)
///     pilot        some of the rays are culled down parts of a box tree (choose_by_sample); other techniques are ruled out
///                  by bounds, or compared by their closed forms
///     structural   the same with rays that are not those of the run: a structural_sample. So the prediction has a standard
///                  error, takes the same time for any number of rays, and uses no rays that will be searched. The number of
///                  hits is the expected one (model::expected_hits).
///
/// A closed form counts doubt_of times as long as it predicts. Costs are those of costs_for.
///
/// Throws std::invalid_argument for a question that lacks what its rigor needs, for a number of rays out of 1 … 1e18, if no
/// technique is allowed, and for pilots if the problem cannot be piloted (sim::PilotedDiscs::can_pilot), for costs of
/// the plain engine and if box-tree is disabled; as model::rank; sim::Stopped on a stop request.
[[nodiscard]] Choice choose(const Question& question, const Valid<CostTable>& costs);

/// What `choose` would choose with discs of another radius and with another number of rays, without another pilot: the
/// counts of the choice's candidates are extrapolated (Prediction::counts_at; those without are left out), and compared
/// with the closed forms of other techniques, except those that were not examined. The errors of counts are not known, and
/// are 0. A choice by closed forms is made again. `question` must be that of the choice, and have a workload.
///
/// Throws as choose, and std::invalid_argument if no candidate of a pilot has counts_at, and for a ratio of radii that is
/// not > 0 and finite.
[[nodiscard]] Choice choose_again(const Choice& choice, const Question& question, double radius_ratio, double rays,
                                  const Valid<CostTable>& costs);

/// The costs with which `choose` compares: those given, or costs_of_sums if the powers of the question's rays differ.
[[nodiscard]] CostTable costs_for(const Question& question, const CostTable& costs);

/// The choice's index, from what the pilot has sorted. Call it once.
[[nodiscard]] std::unique_ptr<sim::Index> build_choice(Choice& choice, const sim::Problem& problem,
                                                       const sim::RunOptions& options);

}  // namespace detp::validate
