#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "detp/validate/bench/summary.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/regret/regret_summary.hpp"

/// The results of `bench` and `bench --regret` in the three formats.
namespace detp::cli {

/// The benchmark's results in the three formats: one result for each instruction set, on the same workloads. `missing` has the reasons why
/// scenes were left out. The exit code is `refuted` if one of our techniques found wrong hits, `stopped` if a stop request
/// ended the benchmark.
[[nodiscard]] Result report_bench(std::span<const validate::BenchResult> benches, const validate::BenchOptions& options,
                                  const std::vector<std::string>& missing, const Screen& screen);

/// The results of `bench --regret` in the three formats, with a summary for each number of threads in `threads`.
/// `missing` has the reasons why scenes were left out. Marked as stopped if a stop request ended it.
[[nodiscard]] Result report_regret(const validate::RegretResult& regret, const std::vector<int>& threads,
                                   const std::vector<std::string>& missing, const Screen& screen);

inline constexpr std::size_t most_worst_choices = 10;  ///< number of choices that reports list as the worst

/// The candidate of a baseline, one of baselines(), by its index; nullopt if it depends on the workload.
[[nodiscard]] std::optional<Candidate> candidate_of(std::size_t baseline, const validate::BaselineSummary& summary);

/// A row for each workload, number of threads and tier, with the regrets of the baselines. `summaries` has one summary
/// for each number of threads in the rows.
[[nodiscard]] Json regret_rows_json(const validate::RegretResult& regret,
                                    const std::vector<validate::RegretSummary>& summaries);
[[nodiscard]] std::string regret_rows_csv(const validate::RegretResult& regret,
                                          const std::vector<validate::RegretSummary>& summaries);

/// The first summary, in `by_threads` all summaries, and the `worst` choices.
[[nodiscard]] Json regret_summary_json(const validate::RegretResult& regret,
                                       const std::vector<validate::RegretSummary>& summaries);

}  // namespace detp::cli
