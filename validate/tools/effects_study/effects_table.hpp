#pragma once

#include <string>

#include "effect_changes.hpp"
#include "study_summary.hpp"
#include "study_workload.hpp"

namespace detp::study {

/// Rows of effects.csv: for each workload one for each effect.
class EffectsTable {
 public:
  void add(const StudyWorkload& workload);
  [[nodiscard]] const std::string& csv() const { return csv_; }
  /// What switching an effect changes; predicted over counted tests and hits, with the effects that evidence calls for and
  /// with none; as Markdown.
  [[nodiscard]] std::string summary() const;

 private:
  /// Of the scenes on which thresholds were selected, or of the others.
  struct Half {
    Ratios tests[2];  ///< of isotropic lines, of photon paths
    Ratios hits[2];
    Ratios tests_without[2];
    Ratios hits_without[2];
  };
  Half tuned_, held_out_;
  EffectChanges changes_;
  std::string csv_ = std::string(workload_head) +
                     ",effect,value,standard_error,threshold,tolerance,on,close,evidence_seconds,"
                     "tests_if_switched,hits_if_switched,counted_tests_if_switched,counted_hits_if_switched,predicted_"
                     "over_counted_tests,predicted_over_counted_hits,"
                     "choice,choice_if_switched\n";
};

}  // namespace detp::study
