#pragma once

#include <string>
#include <vector>

#include "detp/sim/effects/observe.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/regret/regret_workloads.hpp"

/// What both tables of the study need of a workload.
namespace detp::study {

/// A workload with its rays and discs. It is not copied, because the problem refers to the job.
class StudyWorkload {
 public:
  /// How much evidence is collected.
  enum class Effort {
    all,    ///< as `detp scene` does
    priced  ///< as `choose` does
  };
  /// Throws as make_regret_job, and std::invalid_argument for fewer than 50 samples.
  StudyWorkload(const validate::RegretWorkload& workload, Effort effort);
  StudyWorkload(const StudyWorkload&) = delete;
  StudyWorkload& operator=(const StudyWorkload&) = delete;

  [[nodiscard]] const validate::RegretWorkload& workload() const { return workload_; }
  /// The effects that evidence calls for.
  [[nodiscard]] const sim::Observed& automatic() const { return job_.observed(); }
  [[nodiscard]] sim::Observed observe(const sim::EffectSelection& selection) const;
  /// With this effect the other way round than evidence says, and all others as they are; with the same rays.
  [[nodiscard]] sim::Observed observe_switched(const sim::Effect& effect) const;
  /// The workload with rays that are made like this.
  [[nodiscard]] validate::RegretWorkload made_switched(const sim::Effect& effect) const;
  [[nodiscard]] Counts<double> count(const Candidate& candidate) const;
  /// The values of workload_head.
  [[nodiscard]] std::string row() const;

 private:
  [[nodiscard]] sim::EffectSelection switched(const sim::Effect& effect) const;

  validate::RegretWorkload workload_;
  validate::Job job_;
  sim::Problem problem_;
};

/// The columns of StudyWorkload::row.
inline constexpr const char* workload_head = "scene,tuned,field,disc_radius,rays,samples";

/// The box tree for which `detp scene` shows what switching an effect changes.
[[nodiscard]] inline Candidate usual_tree() { return {Technique::box_tree, BoxTreeParameters{8, 16}}; }

[[nodiscard]] inline double tests_of(const Counts<double>& counts) { return counts.cull_tests + counts.disc_tests; }

/// The fastest candidate by closed forms and built-in unit costs.
[[nodiscard]] Candidate chosen_for(const Workload& workload);

/// "box-tree fan-out 8; leaf 16": without commas.
[[nodiscard]] std::string cell_of(const Candidate& candidate);

}  // namespace detp::study
