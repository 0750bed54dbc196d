#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "calibrate.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/search/problem.hpp"

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

/// Seconds for checking the discs and the rays of a search, which is a part of it: the shortest of some.
struct CheckSeconds {
  double discs = 0;
  double rays = 0;
};
[[nodiscard]] CheckSeconds time_checks(const sim::Problem& problem, std::span<const sim::Ray> rays,
                                       std::span<const sim::Disc> discs);

/// Parameters from too coarse to too fine; `place` varies them from workload to workload.
[[nodiscard]] std::vector<Candidate> timed_candidates(const TimedWorkload& workload, std::size_t place);

/// The times of one candidate on one number of threads, taken in rounds. The runs of a round follow each other, so that
/// the data are in the caches; their shortest time counts. Between two rounds other candidates run, so that a disturbance
/// by other programs rarely lasts for both.
class RoundTimes {
 public:
  void begin_round() {
    seconds_.push_back(std::numeric_limits<double>::infinity());
    preparing_.push_back(std::numeric_limits<double>::infinity());
  }

  void add(double seconds, double preparing) {
    seconds_.back() = std::min(seconds_.back(), seconds);
    preparing_.back() = std::min(preparing_.back(), preparing);
  }

  [[nodiscard]] std::size_t rounds() const { return seconds_.size(); }
  [[nodiscard]] bool timed() const { return !seconds_.empty() && seconds() > 0 && seconds() < unknown; }

  /// Whether the shortest times of two rounds agree. A time that only one round reached may be a stroke of luck, such as a
  /// processor that was faster for a moment; much longer times were disturbed.
  [[nodiscard]] bool agree() const {
    constexpr double tolerance = 0.05;
    double least = unknown;
    double next = unknown;
    for (const double one : seconds_) {
      next = std::min(next, std::max(one, least));
      least = std::min(least, one);
    }
    return next < unknown && next <= (1 + tolerance) * least;
  }

  [[nodiscard]] double seconds() const { return *std::min_element(seconds_.begin(), seconds_.end()); }
  [[nodiscard]] double preparing() const { return *std::min_element(preparing_.begin(), preparing_.end()); }
  /// The median of the rounds' seconds over the shortest; of two rounds 1.
  [[nodiscard]] double usual_over_shortest() const {
    std::vector<double> rounds = seconds_;
    const auto middle = rounds.begin() + static_cast<std::ptrdiff_t>((rounds.size() - 1) / 2);
    std::nth_element(rounds.begin(), middle, rounds.end());
    return *middle / seconds();
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::infinity();

  std::vector<double> seconds_;  ///< the shortest of each round
  std::vector<double> preparing_;
};

/// Measures UnitCosts::touch and sets it for all techniques: seconds for touching a byte of memory for the first time, in large pages where
/// the system offers them, as searches do. The shortest of some tries; a few milliseconds in all. Where there is no memory for it, the costs
/// stay.
void set_touch_cost(Calibration& calibration);

}  // namespace detp::validate
