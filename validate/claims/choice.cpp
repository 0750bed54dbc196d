#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "batches.hpp"
#include "claim.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "experiments.hpp"

/// Counts of searches of the rays for which a choice is made: as the choice predicts them, and with the effects of the workload.
namespace detp::validate {
namespace {

struct CountedBatch {
  double rays = 0;
  Counts<double> counts;
};

/// The counts of some of the rays, and of parts of these.
struct CountedSearch {
  CountedBatch all;
  std::vector<CountedBatch> batches = {};  ///< at most batch_count, each with rays from everywhere
};

/// Distributes all rays over the batches in short runs of neighbouring rays. So the segments of one photon's path
/// mostly stay together, and each batch has rays from all parts of a sorted file.
std::vector<std::vector<sim::Ray>> distribute_over_batches(const std::vector<sim::Ray>& rays) {
  const std::size_t batches = std::min<std::size_t>(batch_count, rays.size());
  const std::size_t run = std::clamp<std::size_t>(rays.size() / batches, 1, 64);
  std::vector<std::vector<sim::Ray>> parts(batches);
  for (std::size_t i = 0; i < rays.size(); ++i) parts[i / run % batches].push_back(rays[i]);
  return parts;
}

/// Searches this share of the rays of experiment.choice, which must be set: first all of them at once, then in parts.
/// Returns nothing after a stop request.
std::optional<CountedSearch> count_search(const Experiment& experiment, const Candidate& candidate, double share = 1) {
  const ChoiceQuestion& question = *experiment.choice;
  const auto taken = static_cast<std::size_t>(std::ceil(share * static_cast<double>(question.rays.size())));
  // An evenly spaced sample.
  std::vector<sim::Ray> rays;
  for (std::size_t i = 0; i < taken; ++i) rays.push_back(question.rays[(i + 1) * question.rays.size() / taken - 1]);
  bool stopped = false;
  const auto counts_of = [&](const std::vector<sim::Ray>& some) {
    const sim::Problem problem = sim::make_problem(some, experiment.discs, question.workload.front_facing);
    const sim::Outcome outcome = sim::run(problem, candidate, {.stop = experiment.stop});
    if (outcome.stopped) stopped = true;
    return CountedBatch{static_cast<double>(some.size()), as_expected(outcome.counts)};
  };
  CountedSearch counted{.all = counts_of(rays)};
  for (const std::vector<sim::Ray>& batch : distribute_over_batches(rays)) counted.batches.push_back(counts_of(batch));
  if (stopped) return std::nullopt;
  return counted;
}

/// The value for `rays` rays, scaled from the counted ones. It must add up over rays. The standard error is that between
/// the batches, but at least that of independent events whose expected number is `predicted`; infinite if there is a
/// single ray.
Estimate observed_in(const CountedSearch& counted, const std::function<double(const Counts<double>&)>& value,
                     double predicted, double rays) {
  const double scale = rays / counted.all.rays;
  Estimate estimate{scale * value(counted.all.counts), std::numeric_limits<double>::infinity()};
  if (counted.batches.size() < 2) return estimate;
  std::vector<double> parts;
  for (const CountedBatch& batch : counted.batches) parts.push_back(rays / batch.rays * value(batch.counts));
  estimate.standard_error = std::max(batch_means(parts).standard_error, std::sqrt(scale * predicted));
  return estimate;
}

/// A usual box tree: `detp scene` shows for it what switching an effect changes.
Candidate usual_tree() { return {Technique::box_tree, BoxTreeParameters{8, 16}}; }

/// See the figures in the README of this folder.
constexpr double effects_tolerance = 0.5;

/// Observed counts multiplied by unit costs give times that are wrong by a factor of 1.23 in the median. So a predicted
/// count within 25 % of the observed count is not the main cause of a wrong predicted time.
constexpr double choice_tolerance = 0.25;

/// Techniques that process each ray separately are counted on a sample of the rays if the predicted time for all rays
/// is longer than this.
constexpr double most_seconds_of_all_rays = 3;

/// True if the technique processes each ray separately. A share of the rays then needs the same share of the tests.
bool searches_ray_by_ray(Technique technique) {
  return technique == Technique::brute_force || record_of(technique).ray_by_ray;
}

double share_counted(const Prediction& ranked) {
  return searches_ray_by_ray(ranked.candidate.technique) ? std::min(1.0, most_seconds_of_all_rays / ranked.time.total())
                                                         : 1;
}

/// True if the count is a claim: it is `hits`, or has a unit cost > 0 for this technique.
bool is_claimed(const CountTerm<double>& term, Technique technique) {
  if (term.name == "loaded" || term.name == "segments" || term.name == "sorted" || term.name == "bytes_touched")
    return false;  // the numbers of rays and discs, which are inputs; what follows from counts
  Counts<double> one;
  one.*term.term = 1;
  return term.name == "hits" ||
         price(one, built_in_unit_costs(), technique).total() > price({}, built_in_unit_costs(), technique).total();
}

/// A count that is a claim.
struct ClaimedCount {
  std::string id;
  std::string quantity;
  std::function<double(const Counts<double>&)> value;
  bool adds_up = true;  ///< over rays; false: it is that of the counted rays, and exact
};

/// What the findings about one candidate have in common.
struct CandidateFacts {
  Candidate candidate;
  Counts<double> predicted;
  std::string source;  ///< of the prediction
  double rays = 0;     ///< for which it is
  double tolerance = 0;
};

std::vector<Finding> findings_of(const CandidateFacts& facts, const CountedSearch& counted,
                                 const std::vector<ClaimedCount>& claimed, const sim::Stopwatch& clock) {
  std::vector<Finding> findings;
  for (const ClaimedCount& one : claimed) {
    const double predicted = one.value(facts.predicted);
    const Estimate found = one.adds_up ? observed_in(counted, one.value, predicted, facts.rays)
                                       : Estimate{one.value(counted.all.counts), 0};
    if (predicted == 0 && found.mean == 0) continue;
    findings.push_back({.id = one.id,
                        .quantity = one.quantity,
                        .technique = std::string(name(facts.candidate.technique)),
                        .parameters = describe(facts.candidate),
                        .predictions = {{Form::corrected, facts.source, predicted}},
                        .observed = found,
                        .batches = one.adds_up ? std::max(2, static_cast<int>(counted.batches.size())) : 0,
                        .tolerance = facts.tolerance,
                        .lines = static_cast<std::uint64_t>(counted.all.rays),
                        .seconds = clock.seconds()});
  }
  return findings;
}

std::vector<Finding> candidate_findings(const Experiment& experiment, const Prediction& ranked) {
  const sim::Stopwatch clock;
  const auto counted = count_search(experiment, ranked.candidate, share_counted(ranked));
  if (!counted) return {};
  const std::string_view technique = name(ranked.candidate.technique);
  const std::string parameters = describe(ranked.candidate);
  std::vector<ClaimedCount> claimed;
  for (const CountTerm<double>& term : count_terms<double>) {
    if (!is_claimed(term, ranked.candidate.technique)) continue;
    std::string count(term.name);
    std::ranges::replace(count, '_', '-');
    claimed.push_back(
        {fmt::format("choice.{}.{}", technique, count),
         fmt::format("{} of {}{}{}, as choose predicts them", count, technique, parameters.empty() ? "" : " ",
                     parameters),
         [of = term.term](const Counts<double>& counts) { return counts.*of; },
         term.name != "culls" && term.name != "visits" && term.name != "placements" && term.name != "made"});
  }
  return findings_of({ranked.candidate, ranked.counts, "the closed form that choose prices",
                      static_cast<double>(experiment.choice->rays.size()), choice_tolerance},
                     *counted, claimed, clock);
}

}  // namespace

std::vector<Finding> choice_findings(const Experiment& experiment) {
  std::vector<Finding> findings;
  if (!experiment.choice) return findings;
  for (const Prediction& ranked : model::rank(experiment.choice->workload, built_in_unit_costs())) {
    if (experiment.stop.stop_requested()) break;
    for (Finding& finding : candidate_findings(experiment, ranked)) findings.push_back(std::move(finding));
  }
  return findings;
}

double choice_work(const Experiment& experiment) {
  double work = 0;
  if (!experiment.choice) return work;
  for (const Prediction& ranked : model::rank(experiment.choice->workload, built_in_unit_costs()))
    work += 2 * share_counted(ranked) * test_work(ranked.counts) +  // on all sampled rays, and on parts of them
            (1 + batch_count) * build_work(ranked.counts);
  return work;
}

std::vector<Finding> effect_findings(const Experiment& experiment) {
  if (!experiment.choice || experiment.stop.stop_requested()) return {};
  const sim::Stopwatch clock;
  const Workload& workload = experiment.choice->workload;
  const auto counted = count_search(experiment, usual_tree());
  if (!counted) return {};
  const std::string of_tree =
      fmt::format("of {} {}, predicted with {}", name(Technique::box_tree), describe(usual_tree()),
                  experiment.choice->effects.empty() ? "no effect" : experiment.choice->effects);
  return findings_of({usual_tree(), model::predict(workload, usual_tree()), "the closed form with these effects",
                      workload.rays, effects_tolerance},
                     *counted,
                     {{"effects.tests", "tests of rays with boxes and discs " + of_tree, &tests<double>},
                      {"effects.hits", "hits " + of_tree, &Counts<double>::hits}},
                     clock);
}

double effect_work(const Experiment& experiment) {
  if (!experiment.choice) return 0;
  const Counts<double> counts = model::predict(experiment.choice->workload, usual_tree());
  return 2 * test_work(counts) + (1 + batch_count) * build_work(counts);
}

}  // namespace detp::validate
