#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/search/outcome.hpp"

namespace detp::sim {
class Index;
class PilotedDiscs;
class Problem;
struct Ray;
}  // namespace detp::sim

/// Chooses by a pilot: some of the rays, through parts of the index.
namespace detp::validate {

/// A candidate as the pilot sees it.
struct Piloted {
  Candidate candidate = {};
  Counts<double> counts = {};  ///< expected
  CostBreakdown time = {};     ///< expected, seconds
  int threads = 1;             ///< for which the time is expected
  /// Seconds. Standard error of the time: that of the counts (as if all counts were off in the same direction) and that of
  /// the unit costs. Of a closed form, the time itself.
  double error = 0;
  /// standard errors of the counts; 0: exact, as the tests of brute force. Those of a closed form are not known.
  Counts<double> counts_error = {};
  bool closed_form = false;  ///< its counts are those of the closed form, which may be off by a factor of two
  std::vector<std::string> extrapolated = {};  ///< as model::Ranked: reasons why the closed form may be off farther
  /// The counts with the radius of the discs multiplied by `radius_ratio`, and with another number of rays. Empty without
  /// PilotOptions::for_replans, and for candidates that the pilot did not count.
  std::function<Counts<double>(double radius_ratio, double rays)> counts_at = {};
};

/// A technique that was not tried, because the unit costs say that it is slower than the choice.
struct RuledOut {
  Technique technique;
  double seconds;  ///< by_bound: the least that it could take; otherwise, by its closed form
  bool by_bound;
};

struct PilotChoice {
  std::vector<Piloted> candidates;  ///< the choice first, then the others in the order of their time
  std::vector<RuledOut> ruled_out;
  std::vector<Technique> unexamined;  ///< could still win, but finding out would take longer than it could save
  double sort_seconds = 0;            ///< for sorting the discs, which the run needs anyway
  double pilot_seconds = 0;           ///< for everything else
  std::size_t sampled_rays = 0;
  std::shared_ptr<sim::PilotedDiscs> discs;  ///< kept for the run; null if there was no pilot
  bool predicted = true;  ///< false: counts and times of the choice are rough guesses (PilotOptions::only_choice)

  [[nodiscard]] const Piloted& choice() const { return candidates.front(); }
};

struct PilotOptions {
  int threads = 1;                           ///< most threads, for the pilot and for the choice; 0: all cores
  bool independent_sample = false;           ///< as sim::PilotRays::independent
  std::optional<double> expected_hits = {};  ///< as sim::PilotRays::hits
  std::span<const sim::Ray> others = {};     ///< as sim::PilotRays::others; default: the problem's rays
  /// for the closed forms of other techniques; default: measured, if the problem has rays and the closed forms are needed
  std::optional<Workload> workload = {};
  bool for_replans = false;              ///< set Piloted::counts_at
  std::vector<Technique> disabled = {};  ///< techniques that may not be chosen; box-tree must be allowed
  bool all_closed_forms = false;         ///< compare closed forms even if that takes longer than it could save
  /// no prediction is wanted. For a short search, a pilot would take longer than its choice saves: then the choice is the
  /// usual_shape() of a box tree
  bool only_choice = false;
  std::stop_token stop = {};
};

/// The number of rays that a pilot samples: 64 to 2048, the more the longer the search will take.
[[nodiscard]] std::size_t pilot_size(double rays, double discs);

/// A stratified sample of the rays, of pilot_size.
[[nodiscard]] std::vector<sim::Ray> pilot_sample(std::span<const sim::Ray> rays, std::size_t discs);

/// The candidate that finds the hits of `rays` rays fastest by the simd engine, on how many threads, and how long it will
/// take. `sample` are some of these rays, drawn at random or in strata, as by pilot_sample.
///
/// The shapes of box trees are compared by sim::PilotedDiscs; brute force by its exact counts. Every other exact
/// technique is ruled out if a search with the least counts that are possible takes longer than the best box tree: each
/// disc sorted, placed and visited once, each ray loaded, each hit tested. (If rays reach few of the discs, a search
/// may visit fewer.) A technique that this does not rule out is compared by its closed form, if the closed forms and
/// the evidence that they need take less than 2 % of the best; it is ruled out if it takes twice as long as the best,
/// and chosen if it takes less than half as long. It is never chosen if its closed form is extrapolated: in real scenes,
/// its tests were off by up to 17 times. Brute force is chosen if it takes less time than sorting and placing the discs alone; then there is no pilot. After the
/// pilot, the discs are sorted, and it is chosen only if it is faster than the rest of the run.
///
/// Throws std::invalid_argument if the problem cannot be piloted (PilotedDiscs::can_pilot), for an empty sample, for a
/// number of rays out of 1 … 1e18, for costs of the plain engine and if box-tree is disabled; sim::Stopped on a stop request.
[[nodiscard]] PilotChoice choose_by_pilot(const sim::Problem& problem, std::span<const sim::Ray> sample, double rays,
                                          const Valid<CostTable>& costs, const PilotOptions& options = {});

/// The same for the problem's rays, of which it takes a stratified sample.
[[nodiscard]] PilotChoice choose_by_pilot(const sim::Problem& problem, const Valid<CostTable>& costs,
                                          const PilotOptions& options = {});

/// What choose_by_pilot would choose with discs of another radius and with another number of rays, without another
/// pilot: the counts of the pilot's candidates are extrapolated (Piloted::counts_at; those without are left out), and
/// compared with the other techniques, except those that the pilot did not examine. The errors of counts are not known,
/// and are 0. `problem` must be the pilot's; options.workload, if it is set, must have the other radius.
///
/// Throws std::invalid_argument if no candidate has counts_at, for a ratio of radii that is not > 0 and finite, and for
/// a number of rays out of 1 … 1e18.
[[nodiscard]] PilotChoice choose_again(const PilotChoice& pilot, const sim::Problem& problem, double radius_ratio,
                                       double rays, const Valid<CostTable>& costs, const PilotOptions& options = {});

/// The choice's index, from what the pilot has sorted. Call it once.
[[nodiscard]] std::unique_ptr<sim::Index> build_choice(PilotChoice& choice, const sim::Problem& problem,
                                                       const sim::RunOptions& options);

}  // namespace detp::validate
