#pragma once

#include <functional>
#include <string>
#include <vector>

#include "detp/validate/choice/choice.hpp"
#include "detp/validate/job/job.hpp"

/// The ways to choose a candidate (tiers) whose regret is measured.
namespace detp::validate {

/// What a tier chose.
struct Chosen {
  Prediction prediction;        ///< of a run with the candidate
  double choosing_seconds = 0;  ///< time that choosing took

  /// Of a repeated run. 0: not predicted, only guessed.
  [[nodiscard]] double predicted_seconds() const {
    return prediction.source == Source::guess ? 0 : prediction.time.again();
  }
};

struct Chooser {
  std::string name;  ///< of the tier: "estimate"
  std::function<Chosen(const sim::Problem&, const Job&, int most_threads)> choose;
};

/// All tiers, one line each in choosers.cpp. `costs` are the unit costs with which they predict times.
///
///     pilot      choose, with a prediction; choosing_seconds do not include sorting the discs, which the run needs anyway
///     run        the same for one search, as in `detp run`: short ones take the usual shape, with no prediction
///     structural choose with structural rigor; choosing_seconds include those of measuring the workload, but not the sorting
///     estimate   choose by closed forms; choosing_seconds include those of measuring the workload
///     measure    analyse, from the candidates of a pilot; predicted are the measured seconds
[[nodiscard]] std::vector<Chooser> all_choosers(const CostTable& costs);

}  // namespace detp::validate
