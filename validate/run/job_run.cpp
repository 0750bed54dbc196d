#include "job_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "detp/model/rank/predict.hpp"
#include "detp/model/techniques/registry.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/ranked/ranked.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/validate/base/json.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/choice/candidate_json.hpp"

namespace detp::validate {
namespace {

/// Predicted work of a run, in units of sim::StopCheck; 0 if the candidate has no closed form.
double predicted_work(const Workload& workload, const Candidate& candidate, Engine engine, const Choice* choice) {
  if (choice != nullptr) return search_work(choice->best().counts, engine);
  try {
    if (model::has_closed_form(candidate.technique))
      return search_work(model::predict(workload, candidate, engine), engine);
  } catch (const std::invalid_argument&) {  // no closed form for these parameters
  }
  return 0;
}

/// Searches with the index of a choice.
sim::Outcome run_choice(Choice& choice, const sim::Problem& problem, const sim::RunOptions& options) {
  try {
    return sim::run(problem, *build_choice(choice, problem, options), options);
  } catch (const sim::Stopped&) {  // stopped while the index was built
    return sim::unsearched_outcome(problem, options);
  }
}

}  // namespace

JobRun run_job(const Job& job, const sim::EstimateRequest& request, const sim::RunOptions& options,
               const sim::ReportPhase& progress, const Together& together, Choice* choice) {
  const Candidate& candidate = request.candidate;
  const bool pairs = record_of(request.estimator).finds_pairs;
  const std::string doing(pairs ? name(candidate.technique) : name(request.estimator));
  const double work = progress && pairs ? predicted_work(job.given, candidate, options.engine, choice) : 0;
  const double block = job.stream ? static_cast<double>(sim::block_in_memory(job.disc_count())) : job.given.rays;
  const double each = std::min(1.0, block / std::max(1.0, job.given.rays));  // a block's share of the rays
  const auto show = [&](double done) {
    if (progress) progress({doing, done, std::min(1.0, done + each), each * work});
  };
  show(0);
  sim::RunOptions reporting = options;
  if (progress && work == 0) reporting.progress = [&](double share) { progress({doing, share, share}); };
  if (job.stream) {
    sim::OneRank one;
    sim::Ranks& ranks = together.ranks != nullptr ? *together.ranks : one;
    const sim::DiscsInMemory in_memory(job.discs);
    const sim::DiscSource& discs = job.stored_discs ? *job.stored_discs : in_memory;
    const sim::Share share = job.stored_discs ? sim::Share::discs
                             : together.share ? *together.share
                                              : sim::usual_share(job.discs.size(), ranks);
    const sim::StreamOptions stream{.run = reporting, .front_facing = job.front_facing, .progress = show};
    sim::RankedOutcome ranked = sim::run_on_ranks(discs, *job.stream, candidate, stream, ranks, share);
    sim::StreamedOutcome& streamed = ranked.found;
    return {std::move(streamed.outcome), streamed.check_seconds,
            streamed.read_seconds,       streamed.block,
            std::move(ranked.seconds),   share,
            std::move(ranked.results)};
  }
  const bool by_choice = choice != nullptr && request.estimator == sim::Estimator::disc;
  JobRun run{.outcome = by_choice ? run_choice(*choice, job.problem(), reporting)
                                  : sim::estimate(job.problem(), request, reporting),
             .prepare_seconds = job.check_seconds};
  if (!sim::record_of(request.estimator).needs_scene) {
    run.rays_in_memory = job.rays.size();
    return run;
  }
  const sim::Stopwatch watch;
  sim::on_threads(sim::thread_count(options.threads), [&] {
    run.missed = sim::missed_share(*job.scene, job.caster, job.seed, sim::photons_of_share, options.stop);
  });
  run.prepare_seconds += watch.seconds();
  return run;
}

Timing time_runs(const Job& job, const sim::EstimateRequest& request, const JobRun& counted, int repeat,
                 const sim::RunOptions& options, const sim::ReportPhase& progress, const Together& together) {
  std::vector<Timing> timings;
  const double each = 1.0 / std::max(1, repeat);
  for (int i = 0; i < repeat; ++i) {
    const JobRun run = run_job(job, request, options, sim::part_of(progress, i * each, (i + 1) * each), together);
    if (run.outcome.stopped) break;
    timings.push_back({run.outcome.seconds, run.prepare_seconds, {}});
  }
  if (timings.empty()) timings.push_back({counted.outcome.seconds, counted.prepare_seconds, {}});
  std::vector<double> all;
  for (const Timing& timing : timings) all.push_back(timing.total());
  std::sort(timings.begin(), timings.end(), [](const Timing& a, const Timing& b) { return a.total() < b.total(); });
  Timing median = timings[timings.size() / 2];
  median.all = std::move(all);
  return median;
}

RunCandidate agreed(sim::Ranks* ranks, const std::function<RunCandidate()>& of_first) {
  if (ranks == nullptr) return of_first();
  RunCandidate own;
  const Json json = Json::parse(sim::from_first(*ranks, [&] {
    own = of_first();
    return Json{
        {"technique", name(own.candidate.technique)}, {"parameters", to_json(own.candidate)}, {"threads", own.threads}}
        .dump();
  }));
  const std::string technique = json.at("technique");
  return {candidate_of(technique_named(technique).value(), json.at("parameters")), json.at("threads"),
          std::move(own.choice)};
}

}  // namespace detp::validate
