#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/regret/regret_summary.hpp"

/// The rows and summaries of `bench --regret` as JSON and CSV.
namespace detp::cli {

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
