#include <fmt/format.h>

#include <algorithm>

#include "batches.hpp"
#include "counted_search.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "experiments.hpp"

namespace detp::validate {
namespace {

/// Observed counts multiplied by unit costs give times that are wrong by a factor of 1.23 in the median. So a predicted
/// count within 25 % of the observed count is not the main cause of a wrong predicted time.
constexpr double choice_tolerance = 0.25;

/// Techniques that process each ray separately are counted on a sample of the rays if the predicted time for all rays
/// is longer than this.
constexpr double most_seconds = 3;

/// True if the technique processes each ray separately. A share of the rays then needs the same share of the tests.
bool searches_ray_by_ray(Technique technique) {
  return technique == Technique::brute_force || record_of(technique).ray_by_ray;
}

double share_counted(const Prediction& ranked) {
  return searches_ray_by_ray(ranked.candidate.technique) ? std::min(1.0, most_seconds / ranked.time.total()) : 1;
}

bool adds_up_over_rays(std::string_view term) {
  return term != "culls" && term != "visits" && term != "placements" && term != "made";
}

/// The count for all the question's rays, scaled from the sampled rays. The standard error is 0 for a count that does
/// not add up over rays.
Estimate observed(const CountedSearch& counted, const CountTerm<double>& term, double predicted, double rays) {
  if (!adds_up_over_rays(term.name)) return {counted.all.counts.*term.term, 0};
  return observed_in(
      counted, [&](const Counts<double>& counts) { return counts.*term.term; }, predicted, rays);
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

std::string with_dashes(std::string_view text) {
  std::string dashed(text);
  std::replace(dashed.begin(), dashed.end(), '_', '-');
  return dashed;
}

std::vector<Finding> candidate_findings(const Experiment& experiment, const Prediction& ranked) {
  const sim::Stopwatch clock;
  const auto counted = count_search(experiment, ranked.candidate, share_counted(ranked));
  if (!counted) return {};
  const std::string_view technique = name(ranked.candidate.technique);
  const std::string parameters = describe(ranked.candidate);
  const std::string candidate = fmt::format("{}{}{}", technique, parameters.empty() ? "" : " ", parameters);
  const double rays = static_cast<double>(experiment.choice->rays.size());
  std::vector<Finding> findings;
  for (const CountTerm<double>& count_term : count_terms<double>) {
    const std::string_view term = count_term.name;
    const double predicted = ranked.counts.*count_term.term;
    if (!is_claimed(count_term, ranked.candidate.technique)) continue;
    const Estimate found = observed(*counted, count_term, predicted, rays);
    if (predicted == 0 && found.mean == 0) continue;
    findings.push_back({.id = fmt::format("choice.{}.{}", technique, with_dashes(term)),
                        .quantity = fmt::format("{} of {}, as choose predicts them", with_dashes(term), candidate),
                        .technique = std::string(technique),
                        .parameters = parameters,
                        .predictions = {{Form::corrected, "the closed form that choose prices", predicted}},
                        .observed = found,
                        .batches = adds_up_over_rays(term) ? batches_in(*counted) : 0,
                        .tolerance = choice_tolerance,
                        .lines = static_cast<std::uint64_t>(counted->all.rays)});
  }
  for (Finding& finding : findings) finding.seconds = clock.seconds();
  return findings;
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

}  // namespace detp::validate
