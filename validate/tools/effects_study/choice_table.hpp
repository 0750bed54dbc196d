#pragma once

#include <map>
#include <string>
#include <vector>

#include "study_summary.hpp"
#include "study_workload.hpp"

namespace detp::study {

/// Rows of effects_choice.csv: one for each workload. The choices by closed forms with the effects that evidence calls
/// for, with all and with none are searched and counted, together with a few other good candidates. A candidate's time is
/// that of its counts at the built-in unit costs, so that it has no noise.
class ChoiceTable {
 public:
  void add(const StudyWorkload& workload);
  [[nodiscard]] const std::string& csv() const { return csv_; }
  /// As Markdown.
  [[nodiscard]] std::string summary() const;

 private:
  struct Half {
    std::vector<double> tests_over_all;   ///< ratio or inverse, whichever is at least 1
    std::map<std::string, Ratios> tests;  ///< predicted over counted, by selection
    std::map<std::string, std::vector<double>> time_over_best;
    std::map<std::string, std::vector<double>> price;  ///< the same with the time of the evidence
    std::map<std::string, int> causes;                 ///< of a difference of more than 2 % between auto and all
    std::vector<double> evidence, evidence_of_all;     ///< seconds
  };
  Half tuned_, held_out_;
  std::string csv_ = std::string(workload_head) +
                     ",on,tests_over_all,hits_over_all,tests_none_over_all,predicted_over_counted_auto,"
                     "predicted_over_counted_all,predicted_over_counted_none,largest_off,largest_off_change,choice_"
                     "auto,choice_all,choice_none,best,"
                     "regret_auto,regret_all,regret_none,best_seconds,evidence_seconds_auto,evidence_seconds_all\n";
};

}  // namespace detp::study
