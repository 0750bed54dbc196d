#include "pilot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "comparison.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/vocabulary/ray_blocks.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/sim/technique/searcher.hpp"

namespace detp::validate {
namespace {

/// p/u of the costs; where one of these is zero, the usual one.
double placing_of(const CostTable& table) {
  const UnitCosts& costs = table[Technique::box_tree];
  return costs.placement > 0 && costs.disc_test > 0 ? costs.placement / costs.disc_test : usual_placing;
}

/// Looks for the fastest box tree: halves and doubles leaf and fan-out in turn, as long as that is faster.
class ShapeSearch {
 public:
  ShapeSearch(const sim::PilotedDiscs& discs, const Prices& prices, bool for_replans)
      : discs_(discs), prices_(prices), for_replans_(for_replans) {}

  /// Begins with `usual`.
  std::vector<Prediction> run(const BoxTreeParameters& usual) {
    consider(usual);
    for (BoxTreeParameters before{}; !(before == best());) {
      before = best();
      walk(&BoxTreeParameters::leaf, 4, 1024);
      walk(&BoxTreeParameters::fan_out, 4, 64);
    }
    std::ranges::stable_sort(tried_, {}, &Prediction::seconds);
    return std::move(tried_);
  }

 private:
  /// Returns true if the shape is the best so far, and was not tried before.
  bool consider(const BoxTreeParameters& shape) {
    const Candidate candidate{Technique::box_tree, shape};
    if (std::ranges::find(tried_, candidate, &Prediction::candidate) != tried_.end()) return false;
    const auto predicted = discs_.counts(shape, for_replans_);
    tried_.push_back(priced(candidate, predicted.counts, predicted.error, prices_));
    if (for_replans_)
      tried_.back().counts_at = [predicted](double radius_ratio, double rays) {
        return predicted.at(radius_ratio, rays);
      };
    return best() == shape;
  }

  void walk(int BoxTreeParameters::*parameter, int least, int most) {
    const auto step = [&](bool up) {
      BoxTreeParameters next = best();
      next.*parameter = up ? next.*parameter * 2 : next.*parameter / 2;
      return next.*parameter >= least && next.*parameter <= most && consider(next);
    };
    bool rose = false;
    while (step(true)) rose = true;
    if (!rose)
      while (step(false)) continue;
  }

  [[nodiscard]] BoxTreeParameters best() const {
    return std::get<BoxTreeParameters>(
        std::ranges::min_element(tried_, {}, &Prediction::seconds)->candidate.parameters);
  }

  const sim::PilotedDiscs& discs_;
  const Prices& prices_;
  bool for_replans_;
  std::vector<Prediction> tried_;
};

/// Its tests are known. Of its hits, only the pilot's estimate is, or a closed form, which may be off by a factor of two.
Prediction brute_force(const SearchSize& size, double hits, double error_of_hits, const Prices& prices) {
  const auto counts_at = [=](double radius_ratio, double rays) {
    const double blocks = ray_blocks(rays, size.discs, Engine::simd).count();
    return Counts<double>{.loaded = rays,
                          .segments = size.segments ? rays : 0,
                          .visits = blocks * size.discs,
                          .disc_tests = rays * size.discs,
                          .hits = hits * rays / size.rays * radius_ratio * radius_ratio};
  };
  const Candidate candidate{Technique::brute_force, BruteForceParameters{}};
  Prediction found = priced(candidate, counts_at(1, size.rays), {.hits = error_of_hits}, prices);
  found.counts_at = counts_at;
  return found;
}

/// The usual shape, with a rough guess of its counts, from which the number of threads follows.
Prediction usual_box_tree(const BoxTreeParameters& shape, const SearchSize& size, const Prices& prices) {
  constexpr double culls_of_ray = 40;
  constexpr double leaves_of_ray = 5;
  const Counts<double> counts{.loaded = size.rays,
                              .segments = size.segments ? size.rays : 0,
                              .cull_tests = culls_of_ray * size.rays,
                              .disc_tests = leaves_of_ray * shape.leaf * size.rays,
                              .references = size.discs,
                              .placements = size.discs,
                              .sorted = size.discs};
  Prediction found = priced({Technique::box_tree, shape}, counts, {}, prices);
  found.source = Source::guess;
  return found;
}

/// The least time that any box tree takes: that of preparing, and of the search only if it decides whether brute force,
/// which takes `brute` seconds, is faster.
double least_box_tree_seconds(const sim::Problem& problem, std::span<const sim::Ray> sample, const SearchSize& size,
                              double preparing, double brute, const Prices& prices) {
  constexpr double longest_search = 0.5;  // over the time of preparing; brute force is faster only if rays are few
  if (brute < preparing || brute > (1 + longest_search) * preparing) return preparing;
  const std::span<const sim::Ray> rays = problem.rays().empty() ? sample : problem.rays();
  return prices(least_box_tree_counts(problem, rays, size.rays), Technique::box_tree).time.total();
}

/// Below this work, a pilot takes more than it brings: 12 % of a run at 3.3e6, 6 % at 4.1e6, where the usual shape takes some 6 % more time than
/// the best.
constexpr double least_work = 4e6;

/// At least five: with four, the spread between them says so little of its own accuracy that the stated error of counts is 1.3
/// times as large.
std::size_t subtrees_of(double rays, double discs) {
  return static_cast<std::size_t>(std::clamp(work_of(rays, discs) / 50'000, 5.0, 32.0));
}

/// The sample of a search, which `kept` has.
sim::stream::PilotRays sample_of(const Question& question, Rigor rigor, const sim::Problem& problem,
                                 std::vector<sim::Ray>& kept) {
  const std::size_t discs = problem.discs().size();
  if (rigor == Rigor::structural) {
    if (!question.workload) throw std::invalid_argument("a structural choice needs a workload");
    kept = structural_sample(problem.enclosing(), *question.workload,
                             pilot_size(*question.ray_count, static_cast<double>(discs)));
    return {.sample = kept,
            .all = *question.ray_count,
            .independent = true,
            .hits = model::expected_hits(*question.workload)};
  }
  if (question.rays.empty()) throw std::invalid_argument("a pilot needs rays");
  kept = pilot_sample(question.rays, discs);
  return {.sample = kept, .all = *question.ray_count, .others = question.rays};
}

class SampleChoice {
 public:
  SampleChoice(const Question& question, Rigor rigor, const sim::Problem& problem, const Valid<CostTable>& costs,
               double placing)
      : question_(question),
        rigor_(rigor),
        problem_(problem),
        prices_{costs, sim::useful_threads(question.threads)},
        discs_(static_cast<double>(problem.discs().size())),
        usual_(usual_shape(*question.ray_count, discs_, placing)),
        preparing_(prices_({.placements = discs_, .sorted = discs_}, Technique::box_tree).time.total()) {}

  Choice run() && {
    if (!decide_without_pilot()) decide_by_pilot();
    found_.choosing_seconds = watch_.seconds() - found_.sort_seconds;
    return std::move(found_);
  }

 private:
  [[nodiscard]] SearchSize size_of(std::span<const sim::Ray> sample) const {
    return {*question_.ray_count, std::ranges::any_of(sample, [](const sim::Ray& ray) { return !ray.is_line(); }),
            discs_};
  }

  /// Returns true if brute force, or the usual shape for a short search, is the choice without a pilot.
  bool decide_without_pilot() {
    const double rays = *question_.ray_count;
    const double work = work_of(rays, std::min(discs_, 4 * rays));  // of the search, which a pilot makes faster
    const bool is_short = question_.purpose == Purpose::one_search && work < least_work;
    if (is_short && rigor_ == Rigor::pilot) {  // one ray stands for all: nothing is culled
      sample_ = {.sample = question_.rays.first(1), .all = *question_.ray_count};
    } else {
      sample_ = sample_of(question_, rigor_, problem_, kept_);
    }
    const SearchSize size = size_of(sample_.sample);
    if (question_.allows(Technique::brute_force) && is_brute_force_faster(size)) return true;
    if (!is_short) return false;
    found_.candidates = {usual_box_tree(usual_, size, prices_)};
    return true;
  }

  bool is_brute_force_faster(const SearchSize& size) {
    const double hits = sample_.hits         ? *sample_.hits
                        : question_.workload ? model::expected_hits(*question_.workload)
                                             : 0;
    const double error_of_hits = hits > 0 ? hits : size.rays * size.discs;  // nothing is known
    const Prediction brute = brute_force(size, hits, error_of_hits, prices_);
    const double least = least_box_tree_seconds(problem_, sample_.sample, size, preparing_, brute.seconds(), prices_);
    if (brute.seconds() >= least) return false;
    sim::Problem of_sample = problem_;
    sim::set_rays(of_sample, sample_.sample);  // checks the sample, as a pilot does
    found_.candidates = {brute};
    found_.ruled_out = {{Technique::box_tree, least, true}};
    compare_others(question_, size, prices_, false, 0, found_);
    return true;
  }

  void decide_by_pilot() {
    const SearchSize size = size_of(sample_.sample);
    found_.sampled_rays = sample_.sample.size();
    found_.discs =
        std::make_shared<sim::PilotedDiscs>(problem_, sample_, subtrees_of(size.rays, size.discs),
                                            sim::RunOptions{.stop = question_.stop, .threads = question_.threads});
    found_.sort_seconds = found_.discs->sort_seconds();
    found_.candidates =
        ShapeSearch(*found_.discs, prices_, question_.purpose == Purpose::replans).run({8, usual_.leaf});
    if (question_.allows(Technique::brute_force)) {
      const Prediction& tree = found_.best();
      found_.candidates.push_back(brute_force(size, tree.counts.hits, tree.counts_error.hits, prices_));
      put_choice_first(found_.candidates, false, preparing_);
    }
    compare_others(question_, size, prices_, false, preparing_, found_);
  }

  const Question& question_;
  Rigor rigor_;
  const sim::Problem& problem_;
  sim::Stopwatch watch_;
  Prices prices_;
  double discs_;
  BoxTreeParameters usual_;
  double preparing_;
  std::vector<sim::Ray> kept_ = {};
  sim::stream::PilotRays sample_ = {};
  Choice found_ = {};
};

}  // namespace

Choice choose_by_sample(const Question& question, Rigor rigor, const Valid<CostTable>& given) {
  const Valid<CostTable> costs(costs_for(question, given));
  const double placing = placing_of(given);  // usual_shape knows no sums of powers
  const std::string_view what = rigor == Rigor::structural ? "a structural choice" : "a pilot";
  if (question.problem == nullptr) throw std::invalid_argument(fmt::format("{} needs discs", what));
  if (!question.allows(Technique::box_tree))
    throw std::invalid_argument(fmt::format("{} needs box-tree, which is disabled", what));
  if (!sim::PilotedDiscs::can_pilot(*question.problem))
    throw std::invalid_argument(
        fmt::format("rays start too far from the discs for float kernels; {} needs them", what));
  if (costs.engine != Engine::simd)
    throw std::invalid_argument(fmt::format("{} counts for the simd engine, not for plain", what));
  if (rigor == Rigor::structural && question.problem->rays().empty() &&
      question.problem->farthest() < question.problem->enclosing().radius)
    throw std::invalid_argument(fmt::format(
        "a structural choice needs a problem for rays that start up to {} from the centre of the discs (got {})",
        question.problem->enclosing().radius, question.problem->farthest()));
  sim::StopCheck(question.stop, "choosing").now();
  if (rigor == Rigor::pilot || question.problem->rays().empty())
    return SampleChoice(question, rigor, *question.problem, costs, placing).run();
  const sim::Problem without_rays =
      sim::searched_problem(question.problem->discs(), {}, question.problem->front_facing(), question.stop);
  return SampleChoice(question, rigor, without_rays, costs, placing).run();
}

Choice sample_again(const Choice& choice, const Question& question, double radius_ratio,
                    const Valid<CostTable>& given) {
  if (question.problem == nullptr) throw std::invalid_argument("a choice after a pilot needs the pilot's discs");
  const Valid<CostTable> costs(costs_for(question, given));
  const double rays = *question.ray_count;
  const Prices prices{costs, sim::useful_threads(question.threads)};
  const auto discs = static_cast<double>(question.problem->discs().size());
  const double preparing = prices({.placements = discs, .sorted = discs}, Technique::box_tree).time.total();
  Choice found;
  for (const Prediction& one : choice.candidates)
    if (one.counts_at) found.candidates.push_back(priced(one.candidate, one.counts_at(radius_ratio, rays), {}, prices));
  if (found.candidates.empty()) throw std::invalid_argument("a choice without a pilot needs counts of an earlier one");
  const auto is_brute_force = [](const Prediction& one) { return one.candidate.technique == Technique::brute_force; };
  const auto brute = std::ranges::find_if(found.candidates, is_brute_force);
  if (brute != found.candidates.end() && brute->seconds() < preparing) {
    found.candidates = {Prediction(*brute)};
    found.ruled_out = {{Technique::box_tree, preparing, true}};
  } else if (std::ranges::all_of(found.candidates, is_brute_force)) {
    found.unexamined = {Technique::box_tree};
  }
  put_choice_first(found.candidates, false, preparing);
  Question of_others = question;
  for (const Technique technique : choice.unexamined) {
    of_others.disabled.push_back(technique);
    found.unexamined.push_back(technique);
  }
  compare_others(of_others, {rays, found.best().counts.segments > 0, discs}, prices, true, preparing, found);
  return found;
}

}  // namespace detp::validate
