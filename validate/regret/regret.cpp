#include "regret.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/choice/analysis.hpp"
#include "detp/validate/choice/pilot.hpp"
#include "detp/validate/measure/rounds.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

Chosen chosen(const Choice& choice, double seconds_before = 0) {
  return {choice.best(), seconds_before + choice.choosing_seconds};
}

template <Purpose purpose>
Chosen by_pilot(const sim::Problem& problem, const Job& /*job*/, const CostTable& costs, int threads) {
  return chosen(choose({.problem = &problem, .purpose = purpose, .threads = threads}, costs));
}

template <Rigor rigor>
Chosen by_workload(const sim::Problem& problem, const Job& job, const CostTable& costs, int threads) {
  return chosen(choose({.problem = &problem, .workload = job.workload(), .rigor = rigor, .threads = threads}, costs),
                job.observed().seconds);
}

/// The candidates of the pilot, the other techniques and neighbours of the fastest, each run several times.
Chosen by_runs(const sim::Problem& problem, const Job& /*job*/, const CostTable& costs, int threads) {
  const sim::Stopwatch watch;
  const Choice found = choose({.problem = &problem, .threads = threads}, costs);
  const Analysis analysis = analyse(problem, found.candidates, {.threads = threads});
  const Analysed& best = analysis.candidates.at(analysis.best.value_or(0));
  return {{.candidate = best.candidate, .time = {.intersect = *best.seconds}, .threads = best.threads},
          watch.seconds()};
}

std::optional<Prediction> predicted(const Workload& workload, const CostTable& costs, const Contender& contender) {
  const auto& [candidate, threads] = contender;
  if (!model::has_closed_form(candidate.technique)) return std::nullopt;
  try {
    Prediction ranked = model::assess(workload, candidate, costs);
    ranked.threads = threads;
    ranked.time = price(ranked.counts, costs, candidate.technique, threads);
    return ranked;
  } catch (const std::invalid_argument&) {  // some parameters have no closed form
    return std::nullopt;
  }
}

std::string counts_reason(const PredictionError& of_choice, const PredictionError& of_best) {
  const bool is_choice = std::abs(std::log(of_choice.counts)) > std::abs(std::log(of_best.counts));
  const PredictionError& error = is_choice ? of_choice : of_best;
  const std::string_view whose = is_choice ? "choice" : "best";
  if (!std::isfinite(error.worst_ratio))
    return fmt::format("counts: {} of the {} predicted, but none counted", error.worst, whose);
  return fmt::format("counts: {} of the {} predicted {:.2g} times", error.worst, whose, error.worst_ratio);
}

/// With the effort of evidence that `choose` takes.
Job make_regret_job(const BenchWorkload& workload, std::uint64_t seed, const std::stop_token& stop) {
  Job job = make_bench_job(workload, seed, stop);
  job.measuring.effort = sim::EvidenceEffort::for_search(job.given.rays, job.given.samples);
  return job;
}

class RegretRunner {
 public:
  RegretRunner(std::span<const BenchWorkload> workloads, std::span<const Chooser> choosers,
               const RegretOptions& options)
      : workloads_(workloads), choosers_(choosers), options_(options) {}

  RegretResult run_all() && {
    RegretResult result;
    static_cast<SetProgress&>(result) = run_each(
        workloads_, [&](std::size_t i, const sim::ReportPhase& progress) { return run(i, progress); }, options_.stop,
        options_.progress);
    result.rows = std::move(rows_);
    return result;
  }

 private:
  std::string run(std::size_t place, const sim::ReportPhase& progress) try {
    constexpr double share_of_job = 0.05;  // rough share of a workload's time for making scene and rays, for progress
    const BenchWorkload& workload = workloads_[place];
    if (progress) progress({fmt::format("{}, making {:g} rays", workload.scene, workload.rays), 0, share_of_job});
    const Job job = make_regret_job(workload, options_.seed, options_.stop);
    std::vector<int> threads{options_.threads};
    if (options_.more_threads > 0 && has_more_threads(place)) threads.push_back(options_.more_threads);
    const double each = (1 - share_of_job) / static_cast<double>(threads.size());
    double before = share_of_job;
    for (const int number : threads) {
      add_row(workload, job, number, sim::part_of(progress, before, before + each));
      before += each;
    }
    return "";
  } catch (const std::logic_error& error) {  // too long for the memory, or an invalid argument
    return error.what();
  }

  void add_row(const BenchWorkload& workload, const Job& job, int threads, const sim::ReportPhase& progress) {
    const sim::Problem& problem = job.problem();
    std::vector<Chosen> choices;
    for (const Chooser& chooser : choosers_) choices.push_back(choice_of(chooser, problem, job, threads));
    std::vector<std::vector<Candidate>> options;
    for (const Baseline& baseline : baselines()) options.push_back(baseline.candidates(job.workload()));
    std::vector<Contender> asked;
    for (const Chosen& choice : choices) asked.push_back({choice.prediction.candidate, choice.prediction.threads});
    for (const auto& candidates : options)
      for (const Candidate& candidate : candidates)
        if (record_of(candidate.technique).built) asked.push_back({candidate, threads});
    ExhaustiveOptions search = options_.search;
    search.threads = threads;
    search.stop = options_.stop;
    search.progress = titled(progress, fmt::format("{}, {:g} rays", workload.scene, workload.rays));
    const Exhaustive found = measure_all(problem, asked, search);
    if (found.stopped) throw sim::Stopped("stopped while candidates were timed");
    if (!found.best) throw std::length_error("no candidate's index fits in memory");
    RegretRow row{.workload = workload,
                  .rays = job.given.rays,
                  .samples = job.given.samples,
                  .disc_radius = job.given.disc_radius,
                  .threads = threads,
                  .best = found.candidates[*found.best].contender.candidate,
                  .best_threads = found.candidates[*found.best].contender.threads,
                  .best_seconds = found.candidates[*found.best].judging_seconds(),
                  .noise = found.noise,
                  .tried = found.candidates.size(),
                  .choices = {},
                  .baselines = {}};
    for (std::size_t i = 0; i < choices.size(); ++i)
      row.choices.push_back(choice_row(choosers_[i].name, choices[i], job.workload(), found));
    for (const auto& candidates : options) {
      BaselineRow& regrets = row.baselines.emplace_back();
      for (const Candidate& candidate : candidates) regrets.push_back(regret(found, found.find({candidate, threads})));
    }
    rows_.push_back(std::move(row));
  }

  /// The time of choosing is the median of several choices, as runs are judged by medians; one choice is enough if it takes
  /// long. Time that other programs took does not count.
  static Chosen choice_of(const Chooser& chooser, const sim::Problem& problem, const Job& job, int threads) {
    constexpr std::size_t repeats = 3;
    constexpr double long_time = 0.2;  // seconds
    Chosen choice;
    std::vector<double> seconds;
    while (seconds.empty() || (seconds.size() < repeats && seconds.front() < long_time)) {
      const sim::Stopwatch wall;
      const OwnTime time(threads);
      choice = chooser.choose(problem, job, threads);
      seconds.push_back(choice.choosing_seconds * std::min(1.0, time.seconds() / wall.seconds()));
    }
    choice.choosing_seconds = median(std::move(seconds));
    return choice;
  }

  static std::optional<Regret> regret(const Exhaustive& found, const Timed* candidate) {
    if (candidate == nullptr) return std::nullopt;
    return Regret{candidate->judged_ratio(found.candidates[*found.best]), candidate->abandoned};
  }

  [[nodiscard]] ChoiceRow choice_row(const std::string& tier, const Chosen& choice, const Workload& workload,
                                     const Exhaustive& found) const {
    const Timed* chosen = found.find({choice.prediction.candidate, choice.prediction.threads});
    if (chosen == nullptr)
      throw std::length_error(
          fmt::format("{}, the choice of {}, does not fit in memory", title(choice.prediction.candidate), tier));
    return {tier, choice, chosen->judging_seconds(), *regret(found, chosen),
            reason_of_regret(workload, options_.costs, *chosen, found.candidates[*found.best], found.noise)};
  }

  std::span<const BenchWorkload> workloads_;
  std::span<const Chooser> choosers_;
  const RegretOptions& options_;
  std::vector<RegretRow> rows_;
};

}  // namespace

std::vector<Chooser> all_choosers(const CostTable& costs) {
  const auto tier = [&costs](const char* name, auto* choose) {
    return Chooser{name, [costs, choose](const sim::Problem& problem, const Job& job, int threads) {
                     return choose(problem, job, costs, threads);
                   }};
  };
  return {tier("pilot", by_pilot<Purpose::prediction>), tier("run", by_pilot<Purpose::one_search>),
          tier("structural", by_workload<Rigor::structural>), tier("estimate", by_workload<Rigor::estimate>),
          tier("measure", by_runs)};
}

const std::array<Baseline, 5>& baselines() {
  using Candidates = std::vector<Candidate>;
  static const std::array<Baseline, 5> all{
      {{"best_constant", "best constant", false,
        [](const Workload& /*workload*/) {
          Candidates trees;
          for (const int fan_out : {4, 8, 16})
            for (const int leaf : {16, 64}) trees.push_back({Technique::box_tree, BoxTreeParameters{fan_out, leaf}});
          return trees;
        }},
       {"usual_shape", "usual shape", true,
        [](const Workload& workload) {
          return Candidates{{Technique::box_tree, usual_shape(workload.rays, workload.samples)}};
        }},
       {"paper_rule", "paper's rule", true,
        [](const Workload& workload) { return Candidates{model::paper_rule(workload)}; }},
       {"always_embree", "always Embree", false,
        [](const Workload& /*workload*/) {
          return Candidates{{Technique::bvh, BvhParameters{BuildQuality::low}},
                            {Technique::bvh, BvhParameters{BuildQuality::medium}}};
        }},
       {"always_brute_force", "always brute force", false,
        [](const Workload& /*workload*/) { return Candidates{default_candidate(Technique::brute_force)}; }}}};
  return all;
}

RegretResult run_regret(std::span<const BenchWorkload> workloads, std::span<const Chooser> choosers,
                        const RegretOptions& options) {
  return RegretRunner(workloads, choosers, options).run_all();
}

std::string reason_of_regret(const Workload& workload, const CostTable& costs, const Timed& choice, const Timed& best,
                             double noise) {
  if (choice.contender == best.contender) return "";
  const double regret = choice.judged_ratio(best);
  if (regret <= std::max(noise, 1 / noise)) return "within the noise";
  if (choice.contender.candidate == best.contender.candidate)
    return fmt::format("costs of threads: {} chosen, the best takes {}", choice.contender.threads,
                       best.contender.threads);
  const auto of_choice = predicted(workload, costs, choice.contender);
  const auto of_best = predicted(workload, costs, best.contender);
  if (!of_best) return fmt::format("{} has no closed form", title(best.contender.candidate));
  if (!of_choice) return fmt::format("{} has no closed form", title(choice.contender.candidate));
  const double ratio = of_best->time.total() / of_choice->time.total();
  if (ratio < 1) return fmt::format("the best was not tried: predicted {:.2g} times the choice's seconds", ratio);
  if (choice.abandoned)
    return fmt::format("the choice was abandoned after {:.2g} s, predicted {:.2g} s", choice.first_seconds,
                       of_choice->time.total());
  const PredictionError choice_error = prediction_error(*of_choice, choice.counts, choice.judging_seconds(), costs);
  const PredictionError best_error = prediction_error(*of_best, best.counts, best.judging_seconds(), costs);
  if (best_error.counts / choice_error.counts > best_error.unit_costs / choice_error.unit_costs)
    return counts_reason(choice_error, best_error);
  return fmt::format("unit costs: right counts give {:.2g} times the choice's seconds, {:.2g} times the best's",
                     choice_error.unit_costs, best_error.unit_costs);
}

}  // namespace detp::validate
