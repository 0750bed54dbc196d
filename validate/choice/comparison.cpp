#include "comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "detp/model/closed_form/reasons.hpp"

namespace detp::validate {
namespace {

double doubt_of(const Prediction& one, bool counted_scene, bool against_counts) {
  const Technique technique = one.candidate.technique;
  const bool compared = technique == Technique::brute_force || technique == Technique::box_tree;
  if (one.source != Source::closed_form || compared) return 1;
  if (one.extrapolated.empty()) return against_counts ? closed_form_doubt : 1;
  return counted_scene ? closed_form_doubt : std::numeric_limits<double>::infinity();
}

/// The least counts with which any technique can find the hits, other than brute force.
Counts<double> least_counts(const SearchSize& size, double hits) {
  return {.loaded = size.rays,
          .segments = size.segments ? size.rays : 0,
          .visits = size.discs,
          .disc_tests = hits,
          .placements = size.discs,
          .sorted = size.discs,
          .hits = hits};
}

}  // namespace

bool can_measure(const Question& question) {
  return question.workload ||
         (question.problem != nullptr && !(question.rays.empty() && question.problem->rays().empty()));
}

Workload evidence(const Question& question, double rays) {
  const auto measured = [&]() -> Workload {
    if (question.workload) return *question.workload;
    const auto discs = static_cast<double>(question.problem->discs().size());
    const auto of = [&](const sim::Problem& problem) {
      if (question.purpose == Purpose::one_search && question.effects.text() == "auto" &&
          !sim::evidence_can_pay(rays, discs))
        return sim::with_inputs_alone(problem, question.stop);
      return sim::observe(problem, question.surface != nullptr ? *question.surface : sim::SurfaceFacts{},
                          question.effects, question.stop, sim::EvidenceEffort::for_search(rays, discs))
          .workload;
    };
    if (!question.problem->rays().empty()) return of(*question.problem);
    sim::Problem with_rays = *question.problem;
    sim::set_rays(with_rays, question.rays, question.threads);
    return of(with_rays);
  };
  Workload found = measured();
  found.rays = rays;
  return found;
}

std::vector<Prediction> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                        std::span<const Technique> disabled, const model::SearchLimits& limits) {
  std::vector<Prediction> ranking = model::rank(workload, costs, limits);
  const auto removed = std::erase_if(ranking, [&](const Prediction& one) {
    return std::find(disabled.begin(), disabled.end(), one.candidate.technique) != disabled.end();
  });
  if (removed > 0)
    for (Prediction& one : ranking) {
      if (one.tuned || limits.stop.stop_requested()) continue;
      if (auto best = model::best_of(one.candidate.technique, workload, costs, limits)) one = std::move(*best);
    }
  put_choice_first(ranking, model::is_counted_scene(workload));
  return ranking;
}

void put_choice_first(std::vector<Prediction>& candidates, bool counted_scene, double prepared) {
  const bool against_counts =
      std::ranges::any_of(candidates, [](const Prediction& one) { return one.source == Source::sample; });
  for (Prediction& one : candidates) one.doubt = doubt_of(one, counted_scene, against_counts);
  std::ranges::stable_sort(candidates, {}, &Prediction::seconds);
  const auto left = [&](const Prediction& one) {
    return one.doubtful_seconds() - (one.candidate.technique == Technique::box_tree ? prepared : 0);
  };
  const auto choice = std::ranges::min_element(candidates, {}, left);
  if (choice != candidates.end()) std::rotate(candidates.begin(), choice, choice + 1);
}

Prediction priced(const Candidate& candidate, const Counts<double>& counted, const Counts<double>& error,
                  const Prices& prices) {
  const Counts<double> counts =
      with_bytes_touched(counted, candidate, static_cast<const CostTable&>(prices.costs).engine);
  const auto [threads, time] = prices(counts, candidate.technique);
  Counts<double> more = counts;
  more += error;
  const double of_counts = price(more, prices.costs, candidate.technique, threads).total() - time.total();
  return {
      .candidate = candidate,
      .counts = counts,
      .time = time,
      .threads = threads,
      .error = std::hypot(
          of_counts, static_cast<const CostTable&>(prices.costs).relative_error_of(candidate.technique) * time.total()),
      .counts_error = error,
      .source = Source::sample};
}

void compare_others(const Question& question, const SearchSize& size, const Prices& prices, bool all, double prepared,
                    Choice& found) {
  const Counts<double> least = least_counts(size, found.best().counts.hits);
  const auto best = [&] { return found.best().seconds(); };
  // Whether closed forms, and the measurements that they need, take less than some 2 % of the best.
  const auto worth_finding = [&] { return best() > 50 * 0.0025; };
  std::optional<Workload> workload;  // measured when it is first needed
  const auto compare = [&](Technique technique) {
    const double at_least = prices(least, technique).time.total();
    if (at_least >= best()) return found.ruled_out.push_back({technique, at_least, true});
    if (!model::has_closed_form(technique) || !can_measure(question) || !(all || worth_finding()))
      return found.unexamined.push_back(technique);
    if (!workload) workload = evidence(question, size.rays);
    const model::SearchLimits limits{.threads = prices.most_threads,
                                     .stop = question.stop,
                                     .fastest = closed_form_doubt * best() * prices.most_threads};  // on one thread
    auto tuned = model::best_of(technique, *workload, prices.costs, limits);
    if (!tuned) return found.unexamined.push_back(technique);
    const double seconds = tuned->seconds();
    if (seconds >= closed_form_doubt * best()) return found.ruled_out.push_back({technique, seconds, false});
    tuned->error = seconds * (closed_form_doubt - 1);
    found.candidates.push_back(std::move(*tuned));
  };
  for (const Technique technique : exact_techniques)
    if (technique != Technique::box_tree && technique != Technique::brute_force && question.allows(technique))
      compare(technique);
  put_choice_first(found.candidates, workload && model::is_counted_scene(*workload), prepared);
}

}  // namespace detp::validate
