#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "calibration.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/search/problem.hpp"
#include "detp/validate/measure/rounds.hpp"

/// What a calibration times: workloads, candidates and their rounds, and the touching of memory.
namespace detp::validate {

struct TimedWorkload {
  sim::Body body;
  std::size_t samples;
  std::size_t rays;
  double radius;
};

/// Whether there are more discs, or more rays, than the last-level cache holds. Only techniques with short runs are timed
/// on such workloads.
[[nodiscard]] inline bool is_large(const TimedWorkload& workload) {
  constexpr std::size_t many = 200'000;
  return workload.samples > many || workload.rays > many;
}

inline constexpr std::size_t least_workloads = 12;  ///< measured even if that takes longer than asked

/// First least_workloads small ones; then small and large, sparse and dense ones mixed, so that any first part of them can
/// be fitted.
[[nodiscard]] std::vector<TimedWorkload> timed_workloads();

/// `place` is the number of the workload. On every second pair of workloads, the discs follow each other along a curve, as
/// the vertices of many meshes nearly do; on the others, in random order. On every third workload they lie in clusters of
/// different density.
[[nodiscard]] std::vector<sim::Disc> discs_of(const TimedWorkload& workload, std::size_t place);

/// Isotropic lines; on two of eight workloads pieces of them, from 0.1 to 0.5 of the side long; on two pieces of paths, from
/// one sample to another. Uniform samples and lines alone gave costs by which photon paths in scenes, and lines through sparse
/// ones, were predicted 0.83 times as long as measured (median of 58 searches, their counts right); with clusters and paths 0.9.
[[nodiscard]] std::vector<sim::Ray> rays_of(const TimedWorkload& workload, const std::vector<sim::Disc>& discs,
                                            std::size_t place);

/// The discs and rays of a workload.
struct TimedScene {
  TimedScene(const TimedWorkload& workload, std::size_t place);
  TimedScene(const TimedScene&) = delete;
  TimedScene& operator=(const TimedScene&) = delete;

  std::size_t place;
  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
  sim::Problem problem = sim::make_problem(rays, discs);  ///< borrows both
  /// seconds for checking the discs, and the rays, of a search, which is a part of it: the shortest of some
  double checking_discs = std::numeric_limits<double>::infinity();
  double checking_rays = std::numeric_limits<double>::infinity();
};

/// A candidate on such a scene, and its times on some numbers of threads.
struct TimedCandidate {
  const TimedScene* scene;
  Candidate candidate;
  Engine engine;
  Counts<double> counts = {};
  std::vector<int> threads = {1};
  std::vector<RoundTimes> times = {RoundTimes{}};
};

/// Parameters from too coarse to too fine; `place` varies them from workload to workload.
[[nodiscard]] std::vector<Candidate> timed_candidates(const TimedWorkload& workload, std::size_t place);

/// Measures UnitCosts::touch and sets it for all techniques: seconds for touching a byte of memory for the first time, in large
/// pages where the system offers them. (Memory that a process used before costs nothing, new small pages up to 0.35 ns a byte.) The shortest of some tries; a few milliseconds in all. Where there is no memory for it, the costs
/// stay.
void set_touch_cost(Calibration& calibration);

}  // namespace detp::validate
