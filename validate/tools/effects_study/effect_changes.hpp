#pragma once

#include <map>
#include <string>
#include <vector>

#include "detp/sim/effects/observe.hpp"

namespace detp::study {

/// What switching each effect by hand changes, over many workloads.
class EffectChanges {
 public:
  /// `tests` and `hits` are ratios of predictions; `choice` is whether the choice changes.
  void add(const sim::EffectReport& report, double tests, double hits, bool choice);
  /// As Markdown, a row for each effect that can be switched.
  [[nodiscard]] std::string table() const;

 private:
  /// Of the workloads on which the effect is on, or of the others.
  struct Part {
    std::vector<double> tests, hits;  ///< ratios or inverses, whichever are at least 1
    int choices = 0;
  };
  struct Changes {
    Part on, off;
    int close = 0;
    std::vector<double> seconds;
  };
  std::map<const sim::Effect*, Changes> changes_;
};

}  // namespace detp::study
