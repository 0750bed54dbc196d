#pragma once

#include <functional>
#include <string>
#include <vector>

#include "detp/validate/choice/job.hpp"

/// The ways to choose a candidate (tiers) whose regret is measured.
namespace detp::validate {

struct Choice {
  Candidate candidate;
  double predicted_seconds = 0;  ///< of a run with the candidate; 0: not predicted
  double choosing_seconds = 0;   ///< time that choosing took
  int threads = 1;               ///< of that run
};

struct Chooser {
  std::string name;  ///< of the tier: "estimate"
  std::function<Choice(const sim::Problem&, const Job&, int most_threads)> choose;
};

/// All tiers, one line each in choosers.cpp. `costs` are the unit costs with which they predict times.
///
///     pilot      choose_by_pilot; choosing_seconds do not include sorting the discs, which the run needs anyway
///     run        the same for the choice only, as in `detp run`: short searches take the usual shape, with no prediction
///     structural choose_by_structure; choosing_seconds include those of measuring the workload, but not the sorting
///     estimate   the first candidate of allowed_ranking for the job's workload; choosing_seconds include those of
///                measuring the workload
///     measure    analyse, from the candidates of a pilot; predicted are the measured seconds
[[nodiscard]] std::vector<Chooser> all_choosers(const CostTable& costs);

}  // namespace detp::validate
