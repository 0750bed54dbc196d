#include "findings_until.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "detp/validate/job/job.hpp"

namespace detp::validate {

namespace {

constexpr double stage_growth = 8;
constexpr double stage_safety = 1.05;

/// Which stage comes next.
struct StagePlan {
  int test = 1;                ///< number of the next test of the target
  double stage_end = 0;        ///< repetitions at the end of the stage under way; 0: none
  bool stage_is_test = false;  ///< it was planned to reach the target
  bool finished = false;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(StagePlan, test, stage_end, stage_is_test, finished)
};

/// One experiment, and the sums over its repetitions.
struct Repeated {
  bool draws;
  std::vector<Finding> sums = {};  ///< standard errors: sums of their squares
  std::uint64_t repetitions = 0;
  double seconds = 0;
  StagePlan plan = {};
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Repeated, sums, repetitions, seconds, plan)

  /// Throws sim::Stopped.
  void add(FoundOnce found) {
    if (found.stopped) throw sim::Stopped("stopped during an experiment");
    seconds += found.seconds;
    const bool first = repetitions++ == 0;
    if (first) sums = found.findings;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const Finding& one = found.findings[i];
      Finding& sum = sums[i];
      if (one.id != sum.id) throw std::logic_error("a repeated experiment has other findings");
      const double variance = one.observed.standard_error * one.observed.standard_error;
      sum.observed.standard_error = first ? variance : sum.observed.standard_error + variance;
      if (first) continue;
      sum.observed.mean += one.observed.mean;
      sum.batches += one.batches;
      sum.lines += one.lines;
      for (std::size_t k = 0; k < sum.predictions.size(); ++k) sum.predictions[k].value += one.predictions[k].value;
    }
  }

  [[nodiscard]] double times() const { return static_cast<double>(repetitions); }
  [[nodiscard]] double seconds_of_one() const { return seconds / times(); }
  /// The finding can become more accurate.
  [[nodiscard]] bool grows(std::size_t i) const { return draws && sums[i].batches > 0; }

  /// Mean over the repetitions.
  [[nodiscard]] Finding finding(std::size_t i) const {
    Finding mean = sums[i];
    mean.observed.mean /= times();
    mean.observed.standard_error = std::sqrt(mean.observed.standard_error) / times();
    for (FormulaValue& prediction : mean.predictions) prediction.value /= times();
    mean.seconds = seconds;
    return mean;
  }
};

/// All that decides what is found.
nlohmann::json checkpoint_key(const Experiment& experiment, const FindingsTarget& target,
                              std::span<const ExperimentStep> steps) {
  Digest digest;
  const Workload& workload = experiment.workload;
  for (const double value : {workload.rays, workload.samples, workload.disc_radius, workload.sphere_radius,
                             workload.dimension, workload.path_length, workload.ray_density, workload.hit_ratio})
    digest.add(value);
  for (const double side : workload.box) digest.add(side);
  for (const double ratio : experiment.ratios) digest.add(ratio);
  add(experiment.discs, digest);
  if (experiment.choice) add(experiment.choice->rays, digest);
  std::string experiments;
  for (const ExperimentStep& step : steps) experiments += fmt::format(" {}", step.key);
  return {{"seed", experiment.seed},
          {"relative error", target.relative_error},
          {"confidence", target.confidence},
          {"least lines", target.least_lines},
          {"most lines", target.most_lines},
          {"experiments", experiments},
          {"digest of workload, ratios, discs and rays", digest.text()}};
}

class Findings {
 public:
  Findings(const Experiment& experiment, const FindingsTarget& target, std::span<const ExperimentStep> steps,
           const sim::ReportPhase& progress)
      : experiment_(experiment), target_(target), steps_(steps), progress_(progress), shared_(experiment, steps) {
    for (const ExperimentStep& step : steps) experiments_.push_back({step.draws});
  }

  /// From now on the state is written to the file, and if `resume`, goes on from what the file has.
  void keep_in(const std::filesystem::path& path, bool resume) {
    checkpoint_.emplace(path, "validate --until-relative-error", checkpoint_key(experiment_, target_, steps_));
    const auto saved = resume ? checkpoint_->read(experiment_.stop) : std::nullopt;
    if (!saved || saved->is_null()) return;
    try {
      for (std::size_t i = 0; i < experiments_.size(); ++i) saved->at(i).get_to(experiments_[i]);
    } catch (const nlohmann::json::exception& error) {
      throw checkpoint_->damaged(error.what());
    }
  }

  FindingsUntil run() {
    FindingsUntil result;
    try {
      begin();
      for (std::size_t i = 0; i < experiments_.size(); ++i) refine(i);
    } catch (const sim::Stopped&) {
      result.stopped = true;
      save();
    }
    for (const Repeated& one : experiments_)
      for (std::size_t i = 0; i < one.sums.size(); ++i) {
        result.findings.push_back(one.finding(i));
        result.findings.back().refinement = refinement(one, i);
      }
    return result;
  }

 private:
  static constexpr double share_of_first = 0.1;

  void report(const std::string& what, double share, double seconds = 0) const {
    if (progress_) progress_({what, share, 1, 0, seconds});
  }

  /// That the interval of a finding may have at the experiment's next test.
  [[nodiscard]] double allowed(const Repeated& one) const { return error_of_test(target_.confidence, one.plan.test); }

  /// Half width of this interval over the observed value.
  [[nodiscard]] double relative_error(const Repeated& one, std::size_t i) const {
    const Finding mean = one.finding(i);
    if (mean.batches == 0) return 0;
    if (mean.observed.mean == 0) return std::numeric_limits<double>::infinity();
    return interval_width(allowed(one), static_cast<int>(findings()), mean.batches) * mean.observed.standard_error /
           std::abs(mean.observed.mean);
  }

  [[nodiscard]] std::size_t findings() const {
    std::size_t count = 0;
    for (const Repeated& one : experiments_) count += one.sums.size();
    return count;
  }

  /// Number of repetitions that the experiment needs in all, by what is known; within its limits of lines.
  [[nodiscard]] double needed(const Repeated& one) const {
    double most = 1;
    for (std::size_t i = 0; i < one.sums.size(); ++i) {
      if (!one.grows(i)) continue;
      const double error = relative_error(one, i);
      const double lines_of_one = static_cast<double>(one.finding(i).lines) / one.times();
      const double by_error = std::isfinite(error)
                                  ? stage_safety * one.times() * std::pow(error / target_.relative_error, 2)
                                  : std::numeric_limits<double>::infinity();
      const double limit = std::max(1.0, std::floor(target_.most_lines / lines_of_one));
      most = std::max(most, std::min(limit, std::max(by_error, std::ceil(target_.least_lines / lines_of_one))));
    }
    return most;
  }

  [[nodiscard]] bool reached(const Repeated& one) const {
    for (std::size_t i = 0; i < one.sums.size(); ++i)
      if (one.grows(i) && relative_error(one, i) > target_.relative_error) return false;
    return true;
  }

  /// The first repetition of each experiment: one after another, or all at once.
  void begin() {
    std::vector<Repetition> first;
    std::vector<double> costs;
    for (std::size_t i = 0; i < experiments_.size(); ++i) {
      if (experiments_[i].repetitions > 0) continue;
      first.push_back({i, 0});
      costs.push_back(steps_[i].work(experiment_) * steps_[i].unit_time);
    }
    const std::size_t at_once = shared_.at_once() == 1 ? 1 : first.size();
    for (std::size_t done = 0; done < first.size(); done += at_once) {
      report("first counts", share_of_first * static_cast<double>(done) / static_cast<double>(first.size()));
      const auto from = static_cast<std::ptrdiff_t>(done);
      const auto to = static_cast<std::ptrdiff_t>(done + at_once);
      add_all({first.begin() + from, first.begin() + to}, {costs.begin() + from, costs.begin() + to});
    }
  }

  void add_all(const std::vector<Repetition>& repetitions, const std::vector<double>& costs = {}) {
    std::vector<FoundOnce> found = shared_.find(repetitions, costs);
    for (std::size_t i = 0; i < found.size(); ++i) experiments_[repetitions[i].step].add(std::move(found[i]));
    if (checkpoint_ && checkpoint_->due()) save();
  }

  void save() {
    if (!checkpoint_) return;
    nlohmann::json state = nlohmann::json::array();
    for (const Repeated& one : experiments_) state.push_back(one);
    checkpoint_->write(state);
  }

  void refine(std::size_t number) {
    Repeated& one = experiments_[number];
    StagePlan& plan = one.plan;
    while (!plan.finished) {
      if (plan.stage_end == 0) {
        const double wanted = std::ceil(needed(one));
        plan.stage_end = std::min(wanted, stage_growth * one.times());
        plan.stage_is_test = plan.stage_end == wanted;
        plan.finished = wanted <= one.times();
      }
      for (const double begin = one.times(); one.times() < plan.stage_end;) {
        const double left =
            (plan.stage_end - one.times()) * one.seconds_of_one() / static_cast<double>(shared_.at_once());
        report(fmt::format("{:.2g} s more for {:.2g} %", left, 100 * target_.relative_error),
               share_of_first + (1 - share_of_first) * (one.times() - begin) / (plan.stage_end - begin), left);
        std::vector<Repetition> next;
        for (std::uint64_t i = one.repetitions;
             static_cast<double>(i) < plan.stage_end && next.size() < shared_.at_once(); ++i)
          next.push_back({number, i});
        add_all(next);
      }
      plan.stage_end = 0;
      if (!plan.stage_is_test || plan.finished) continue;
      plan.finished = reached(one);
      plan.test += plan.finished ? 0 : 1;
    }
  }

  [[nodiscard]] Refinement refinement(const Repeated& one, std::size_t i) const {
    Refinement found{.relative_error = relative_error(one, i)};
    found.reached = found.relative_error <= target_.relative_error;
    if (found.reached || !one.grows(i)) return found;
    const Finding mean = one.finding(i);
    if (mean.observed.mean == 0)
      found.share_bound = -std::log(allowed(one) / static_cast<double>(findings())) / static_cast<double>(mean.lines);
    const double times = std::pow(found.relative_error / target_.relative_error, 2) - 1;
    found.more_lines = times * static_cast<double>(mean.lines);
    found.more_seconds = times * one.times() * one.seconds_of_one();
    return found;
  }

  const Experiment& experiment_;
  const FindingsTarget& target_;
  std::span<const ExperimentStep> steps_;
  const sim::ReportPhase& progress_;
  std::optional<CheckpointFile> checkpoint_;
  SharedFindings shared_;
  std::vector<Repeated> experiments_;
};

}  // namespace

void check(const FindingsTarget& target) {
  require_ratio("relative error", target.relative_error);
  require_ratio("confidence", target.confidence);
  require_non_negative("least number of lines", target.least_lines);
  require_positive("largest number of lines", target.most_lines);
  if (target.least_lines > target.most_lines)
    throw std::invalid_argument("the least number of lines is above the largest");
}

FindingsUntil findings_until(const Experiment& experiment, const FindingsTarget& target,
                             std::span<const ExperimentStep> steps,
                             const std::optional<std::filesystem::path>& checkpoint, bool resume,
                             const sim::ReportPhase& progress) {
  const sim::DefaultFloatingPoint mode;
  check(target);
  Findings findings(experiment, target, steps, progress);
  if (checkpoint) findings.keep_in(*checkpoint, resume);
  return findings.run();
}

}  // namespace detp::validate
