#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "claim.hpp"
#include "detp/sim/base/phase.hpp"
#include "detp/sim/base/stopped.hpp"

/// The experiments that test the claims. Each experiment counts by simulation, without using a formula.
///
/// The seed determines all results; the number of threads does not affect them. After a stop request, an experiment
/// returns no findings, or throws sim::Stopped.
namespace detp::validate {

/// P(sphere), n_i and P(disc): lines through S₀ are tested against spheres and discs placed at random inside it.
[[nodiscard]] std::vector<Finding> line_hit_findings(const Experiment& experiment);

/// k, m_i, T_R and T_I of the sphere cache on sorted samples, at several Q.
[[nodiscard]] std::vector<Finding> sphere_cache_findings(const Experiment& experiment);

/// Counts of cell spheres, of the sphere tree and, by each engine, of the box tree.
[[nodiscard]] std::vector<Finding> hierarchy_findings(const Experiment& experiment);

/// Cells per line of a grid, ray-disc tests per line of an octree, and hits per line.
[[nodiscard]] std::vector<Finding> disc_index_findings(const Experiment& experiment);

/// The hits, and all counts that have a unit cost, of each candidate of model::rank. model::rank predicts the counts
/// from experiment.choice's workload. They are counted on experiment.choice's rays and experiment.discs. Returns
/// nothing if experiment.choice is not set.
[[nodiscard]] std::vector<Finding> choice_findings(const Experiment& experiment);

/// The tests and hits of a box tree of fan-out 8 with 16 discs in a leaf. They are predicted from experiment.choice's
/// workload, with the effects that it has, and counted on experiment.choice's rays. Refuted if an effect that matters is
/// missing. Returns nothing if experiment.choice is not set.
[[nodiscard]] std::vector<Finding> effect_findings(const Experiment& experiment);

/// Noise of discs and of triangle hits, bias of discs at edges, and how a photon's pieces clump, in @furnace; bias of discs in
/// smooth light.
[[nodiscard]] std::vector<Finding> accuracy_findings(const Experiment& experiment);

/// Predicted work of each experiment, in units of sim::StopCheck, for a display of progress.
[[nodiscard]] double line_hit_work(const Experiment& experiment);
[[nodiscard]] double sphere_cache_work(const Experiment& experiment);
[[nodiscard]] double hierarchy_work(const Experiment& experiment);
[[nodiscard]] double disc_index_work(const Experiment& experiment);
[[nodiscard]] double choice_work(const Experiment& experiment);
[[nodiscard]] double effect_work(const Experiment& experiment);
[[nodiscard]] double accuracy_work(const Experiment& experiment);

struct ExperimentStep {
  std::string_view key;  ///< what --experiments calls it
  const char* name;
  std::vector<Finding> (*run)(const Experiment&);
  double (*work)(const Experiment&);
  double unit_time;  ///< measured time of a unit of the step's work, relative to that of "sphere cache"
  bool draws;        ///< draws its lines and samples by the seed; false: counts on the rays and discs that it is given
};

/// All of the above.
[[nodiscard]] std::span<const ExperimentStep> experiment_steps();

/// The findings of these experiments, or of those that were finished before a stop request. Sets `done`, if not
/// null, to the number of finished experiments. Ranks share the experiments.
[[nodiscard]] std::vector<Finding> all_findings(const Experiment& experiment, const sim::ReportPhase& progress = {},
                                                sim::Progress* done = nullptr,
                                                std::span<const ExperimentStep> steps = experiment_steps());

/// On ranks other than 0 of Experiment::ranks: does what all_findings or findings_until on rank 0 hands out, until it has all.
void serve_findings(const Experiment& experiment, std::span<const ExperimentStep> steps = experiment_steps());

}  // namespace detp::validate
