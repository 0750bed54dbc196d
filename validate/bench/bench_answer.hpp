#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench.hpp"
#include "detp/validate/base/fields.hpp"
#include "detp/validate/calibration/calibration_file.hpp"

/// Our techniques and Embree on the same work: `detp bench`.
namespace detp::validate {

struct BenchRequest {
  BenchEffort effort = BenchEffort::quick;
  BenchAxes axes = {};
  std::string scene_folder = {};  ///< of the meshes; empty: unknown
  std::vector<Technique> techniques = {};
  std::vector<EmbreeMode> embree_modes = best_embree_modes();
  std::vector<std::string> instruction_sets = {""};  ///< a race for each; empty name: all that the machine has
  int threads = 0;                                   ///< 0: one, and all cores
  int repeats = 5;
  std::optional<double> most_hits = {};   ///< default: of the effort
  std::optional<CostRequest> costs = {};  ///< with which our choice is made; none: it does not take part
  std::uint64_t seed = 1;
};

struct BenchAnswer {
  BenchSet set;
  BenchOptions options;                   ///< resolved
  std::vector<BenchResult> benches = {};  ///< one for each instruction set
};

/// Throws as run_bench and costs_in_use do.
[[nodiscard]] BenchAnswer answer(const BenchRequest& request, const std::stop_token& stop = {},
                                 const sim::ReportPhase& progress = {}, const Notice& notice = {});

/// Summary of many races: ratios of Embree's shortest median time to ours.
struct AgainstEmbree {
  int threads = 1;
  std::size_t races = 0;
  double geometric_mean = 0;
  double worst = 0;             ///< the smallest ratio
  std::size_t worst_entry = 0;  ///< index of the entry with the smallest ratio
  /// the share of what our best technique gains on Embree: geometric mean of its time over ours
  double kept = 1;
};

/// Summary over the complete races with `threads` threads; nothing if there is none, or if our choice did not take part.
[[nodiscard]] std::optional<AgainstEmbree> against_embree(std::span<const BenchEntry> entries, int threads,
                                                          Ours ours = Ours::best);

/// True if all our techniques found the right hits in all races.
[[nodiscard]] bool do_own_hits_agree(std::span<const BenchEntry> entries);

/// Embree's wrong hits and all its hits, summed over all of its modes in all races. A mode's runs in one race count as
/// one run: `wrong` is the largest number among them.
struct WrongHits {
  std::uint64_t wrong = 0;
  std::uint64_t hits = 0;
};
[[nodiscard]] WrongHits embree_wrong_hits(std::span<const BenchEntry> entries);

/// A competitor in a race.
struct BenchRow {
  const BenchEntry* entry;
  const CompetitorResult* result;
};

/// The rows of all instruction sets. They refer to the answer.
[[nodiscard]] std::vector<BenchRow> bench_rows(const BenchAnswer& answer);

[[nodiscard]] const Fields<BenchAnswer>& bench_fields();
[[nodiscard]] const Fields<BenchRow>& bench_row_fields();

/// Of bench_fields() and bench_row_fields().
[[nodiscard]] std::vector<FieldText> describe_bench();

}  // namespace detp::validate
