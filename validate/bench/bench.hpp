#pragma once

#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "race.hpp"
#include "workload.hpp"

/// Ours against peers over a set of workloads.
namespace detp::validate {

struct BenchOptions {
  std::vector<Technique> techniques;     ///< of ours; empty: all exact ones
  std::vector<EmbreeMode> embree_modes;  ///< at least one
  std::vector<int> threads = {1};        ///< each workload is run with each of these
  int repeats = 5;
  double enough = 2;       ///< seconds after which no round of a race beyond the third is begun
  double most_hits = 5e6;  ///< a workload for which more are expected is skipped
  double hopeless = 30;    ///< one of ours predicted slower than this times our fastest prediction is not run
  double checkable = 2e7;  ///< rays x discs up to which brute force says which hits are right
  std::uint64_t seed = 1;
  std::stop_token stop = {};
  std::function<void(std::string_view next, double share)> progress = {};
};

/// One race of one workload.
struct BenchEntry {
  BenchWorkload workload;
  double samples = 0;      ///< as many as there are
  double disc_radius = 0;  ///< length
  int threads = 1;
  Technique judge = Technique::brute_force;  ///< whose hits are taken for right
  Race race;

  /// The fastest of a side; null if none of it has run.
  [[nodiscard]] const Finish* best(bool ours) const;

  /// How many times as long Embree took at its best as the best of ours; 0 where not both are known.
  [[nodiscard]] double ratio() const;
};

struct BenchSkip {
  BenchWorkload workload;
  std::string why;
};

struct BenchResult {
  std::vector<BenchEntry> entries;
  std::vector<BenchSkip> skipped;
  std::size_t workloads = 0;  ///< asked for
  std::size_t done = 0;       ///< of them, raced to the end or skipped
  bool stopped = false;       ///< a stop request came before the end
};

/// Races on all workloads. Throws what make_job throws for a scene or a number that is wrong.
[[nodiscard]] BenchResult run_bench(std::span<const BenchWorkload> workloads, const BenchOptions& options);

/// Six modes. On the seven workloads where all 60 were measured (CPU time, 10³ … 10⁵ rays), one of these was the
/// fastest on five, within 1 % of it on one, and 5 % behind on one where each ran only once. All 60 lie close together:
/// on discs neither the quality nor the coherent flag nor packets change much; rtcOccluded, which keeps no nearest hit,
/// is ahead of rtcIntersect by 1 to 5 %.
[[nodiscard]] std::vector<EmbreeMode> best_embree_modes();

}  // namespace detp::validate
