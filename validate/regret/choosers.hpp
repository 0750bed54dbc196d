#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/job/job.hpp"

/// The ways to choose a candidate whose regret is measured: tiers, and simple rules that need no cost model.
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

struct Baseline {
  std::string_view name;  ///< in results: "best_constant"
  std::string_view text;  ///< "best constant"
  bool by_workload;       ///< the candidates differ from workload to workload
  /// The candidates of the rule on a workload, of which one counts: the one with the smallest geometric mean of its
  /// regrets on the fitted workloads. Always the same number.
  std::vector<Candidate> (*candidates)(const Workload&);
};

/// best constant        box trees with a fan-out of 4, 8 or 16 and leaves of 16 or 64
/// usual shape          box tree with the shape of usual_shape()
/// paper's rule         model::paper_rule
/// always Embree        bvh with quality low or medium
/// always brute force   brute-force
[[nodiscard]] const std::array<Baseline, 5>& baselines();

}  // namespace detp::validate
