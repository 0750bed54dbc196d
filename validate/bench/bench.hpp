#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "race.hpp"
#include "workload_sets.hpp"

/// Benchmarks our techniques and Embree over a set of workloads.
namespace detp::validate {

struct BenchOptions {
  std::vector<Technique> techniques;     ///< our techniques to run; empty: all exact techniques
  std::vector<EmbreeMode> embree_modes;  ///< at least one
  /// unit costs with which our choice is made, and takes part where float kernels can search; none: it does not take part
  std::optional<CostTable> costs = {};
  std::vector<int> threads = {1};    ///< each workload is run with each of these numbers of threads
  std::string instruction_set = {};  ///< of our kernels and of Embree; empty: all that the machine has
  int repeats = 5;
  double most_seconds = 2;  ///< after this many seconds, a race starts no fourth or later round
  double most_hits = 5e6;   ///< a workload is skipped if more hits are expected
  /// a technique of ours is left out if its predicted time exceeds this many times our shortest predicted time
  double hopeless = 30;
  double checkable = 2e7;  ///< largest product of rays and discs for which brute force determines the right hits
  std::uint64_t seed = 1;
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct BenchEntry {
  BenchWorkload workload;
  double samples = 0;      ///< actual number of samples
  double disc_radius = 0;  ///< in scene units
  int threads = 1;
  std::string instruction_set = {};          ///< of our kernels
  Technique judge = Technique::brute_force;  ///< the technique whose hits count as right
  Race race;

  /// Our fastest technique if `ours`, else Embree's fastest mode; null if none has run.
  [[nodiscard]] const CompetitorResult* best(bool ours) const;

  /// Our choice; null if it did not take part.
  [[nodiscard]] const CompetitorResult* choice() const;

  /// Embree's best time divided by our best time; 0 if either is unknown or the race is incomplete.
  [[nodiscard]] double ratio() const;

  /// The same for our choice.
  [[nodiscard]] double choice_ratio() const;

 private:
  [[nodiscard]] double embree_over(const CompetitorResult* ours) const;
};

struct BenchResult : SetProgress {
  std::vector<BenchEntry> entries;
};

/// Runs a race on each workload. Throws as make_job does for a wrong scene or number, and std::invalid_argument for an instruction set
/// that this machine or Embree lacks. No other search may run meanwhile if one is named.
[[nodiscard]] BenchResult run_bench(std::span<const BenchWorkload> workloads, const BenchOptions& options);

/// The six modes that `bench` runs by default. All 60 modes were measured on seven workloads (CPU time, 10³ … 10⁵
/// rays). The fastest of these six was the fastest of all modes on five workloads, at most 1 % slower than the fastest
/// on one, and 5 % slower on one where each mode ran only once. The times of all 60 modes are close: on discs the
/// quality, the coherent flag and packets matter little. rtcOccluded, which keeps no nearest hit, is 1 to 5 % faster
/// than rtcIntersect.
[[nodiscard]] std::vector<EmbreeMode> best_embree_modes();

}  // namespace detp::validate
