#include "choose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/validate/structural/structural.hpp"

namespace detp::validate {
namespace {

/// "t, u": the costs that are 0.
std::string zero_costs(const UnitCosts& costs) {
  std::string list;
  for (const UnitCostTerm& one : unit_cost_terms)
    if (costs.*one.cost == 0) list += fmt::format("{}{}", list.empty() ? "" : ", ", one.symbol);
  return list;
}

/// Throws std::invalid_argument if the predicted times cannot be compared.
void check_ranking(const Choice& choice, const CostTable& costs) {
  const Technique best = choice.best().candidate.technique;
  if (!(choice.best().seconds() > 0))
    throw std::invalid_argument(fmt::format(
        "with these unit costs {} takes no time, so that nothing can be compared: {} cost 0; give every operation its "
        "cost in seconds, as --help explains",
        name(best), zero_costs(costs[best])));
  if (!std::isfinite(choice.candidates.back().seconds()))
    throw std::invalid_argument(
        fmt::format("with these unit costs the time of {} exceeds 1.8e308 s and cannot be compared; give smaller costs",
                    name(choice.candidates.back().candidate.technique)));
}

/// The prediction for any candidate, made as the choice was: by the pilot of a box tree; by structural counts, if these were asked for and the rays
/// are isotropic lines; else by its closed form. Nothing if the candidate has no such prediction, if its index does not fit in memory, or
/// if a stop was requested.
std::optional<Prediction> prediction_of(const Candidate& candidate, const ChooseAnswer& answer,
                                        const Question& question, const CostTable& costs) {
  const auto counted = [&](const Counts<double>& counts) {
    const TimeOnThreads fastest = fastest_price(counts, costs, candidate.technique, question.threads);
    return Prediction{.candidate = candidate, .counts = counts, .time = fastest.time, .threads = fastest.threads};
  };
  try {
    if (candidate.technique == Technique::box_tree && answer.choice.discs)
      return counted(answer.choice.discs->counts(std::get<BoxTreeParameters>(candidate.parameters)).counts);
    const Job& job = *answer.job;
    if (answer.choice.rigor == Rigor::structural && job.field == sim::Field::isotropic)
      return counted(
          structural_counts(job.discs, job.given.rays, candidate, question.stop, job.front_facing, costs.engine));
    return model::assess(answer.workload, candidate, costs, question.threads);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  } catch (const std::length_error&) {
    return std::nullopt;
  } catch (const sim::Stopped&) {
    return std::nullopt;
  }
}

class Choosing {
 public:
  Choosing(const ChooseRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress)
      : request_(request), progress_(progress), found_{.costs = request.costs, .costs_origin = request.costs_origin} {
    question_ = {.rigor = request.rigor, .threads = request.threads, .disabled = request.disabled, .stop = stop};
    if (request.rigor == Rigor::measure) question_.rigor.reset();
    if (request.job.numbers_alone() && !request.rigor) question_.rigor = Rigor::estimate;
  }

  ChooseAnswer run() && {
    if (request_.job.numbers_alone() && !request_.analyzes() && request_.rigor != Rigor::structural)
      take_numbers();
    else
      make();
    question_.workload = found_.workload;
    decide();
    if (request_.analyzes() && !found_.stopped) analyse_choice();
    predict_whole();
    if (request_.ranks && !found_.stopped) found_.ranks = choose_ranks(*request_.ranks, found_, question_.stop);
    return std::move(found_);
  }

 private:
  void take_numbers() {
    found_.workload = workload_of_numbers(request_.job);
    found_.effects = sim::effects_of_numbers(found_.workload);
    inputs_ = {.discs = found_.workload.samples, .rays = found_.workload.rays};
  }

  void make() {
    JobRequest request = request_.job;
    request.workload_only = !request_.analyzes();
    request.keep_scene = request_.ranks.has_value();
    const Job& job = found_.job.emplace(make_job(request, question_.stop, sim::part_of(progress_, 0, share_of_job())));
    if (request_.made) request_.made(job);
    found_.workload = job.workload();
    found_.effects = job.observed().effects;
    question_.problem = &job.problem();
    question_.ray_count = job.given.rays;
    const bool by_pilot = question_.rigor.value_or(reachable_rigor(question_, found_.costs)) == Rigor::pilot;
    (by_pilot ? found_.shown_evidence_seconds : found_.evidence_seconds) = job.observed().seconds;
    inputs_ = whole_inputs(request, job, job.given.rays);
  }

  [[nodiscard]] double share_of_job() const { return request_.analyzes() ? 0.3 : 1; }  // a guess

  /// The choice, the paper's rule, brute force and tips.
  void decide() {
    found_.choice = choose(question_, found_.costs);
    found_.rigor = found_.choice.rigor;
    found_.choosing_seconds = found_.evidence_seconds + found_.choice.choosing_seconds;
    priced_ = costs_for(question_, found_.costs);
    check_ranking(found_.choice, priced_);
    const auto assess = [&](const Candidate& candidate) {
      return model::assess(found_.workload, candidate, priced_, question_.threads);
    };
    found_.paper = assess(model::paper_rule(found_.workload));
    found_.brute_force = assess({Technique::brute_force, BruteForceParameters{}}).time.again();
    const sim::Stopwatch watch;
    found_.tips = tips_of(found_.choice, question_, found_.costs);
    found_.tips_seconds = watch.seconds();
    const auto all = std::ranges::count_if(
        exact_techniques, [&](Technique one) { return model::has_closed_form(one) && question_.allows(one); });
    const std::size_t ranked = found_.choice.candidates.size();
    if (!found_.by_sample() && question_.stop.stop_requested() && static_cast<std::ptrdiff_t>(ranked) < all)
      found_.stopped = {ranked, static_cast<std::uint64_t>(all), "techniques ranked"};
    else if (found_.tips.stopped())
      found_.stopped = {found_.tips.inputs, found_.tips.ranges.size(), "inputs examined for tips"};
  }

  void analyse_choice() {
    const sim::Stopwatch watch;
    Analysis analysis = analyse(*question_.problem, found_.choice.candidates,
                                {.disabled = request_.disabled,
                                 .engine = found_.costs.engine,
                                 .check_seconds = found_.job->check_seconds,
                                 .threads = question_.threads,
                                 .stop = question_.stop,
                                 .progress = sim::part_of(progress_, share_of_job(), 1)});
    for (std::size_t i = found_.choice.candidates.size(); i < analysis.candidates.size(); ++i)
      analysis.candidates[i].predicted = prediction_of(analysis.candidates[i].candidate, found_, question_, priced_);
    analysis.stopped = question_.stop.stop_requested();
    if (analysis.stopped)
      found_.stopped = {static_cast<std::uint64_t>(std::ranges::count_if(
                            analysis.candidates, [](const Analysed& one) { return one.seconds.has_value(); })),
                        analysis.candidates.size(), "candidates measured"};
    if (request_.rigor == Rigor::measure && analysis.best) {
      found_.rigor = Rigor::measure;
      found_.choosing_seconds += watch.seconds();
    }
    found_.analysis = std::move(analysis);
  }

  void predict_whole() {
    const Prediction& best = found_.choice.best();
    const double pilot = found_.by_sample() ? static_cast<double>(found_.choice.sampled_rays) : 0;
    found_.whole = {whole_seconds(inputs_, best.time, pilot, best.threads),
                    peak_bytes(inputs_, best.counts.bytes_touched)};
  }

  const ChooseRequest& request_;
  const sim::ReportPhase& progress_;
  ChooseAnswer found_;
  Question question_;
  CostTable priced_ = {};
  WholeInputs inputs_ = {};
};

}  // namespace

ChooseAnswer answer(const ChooseRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress) {
  return Choosing(request, stop, progress).run();
}

}  // namespace detp::validate
