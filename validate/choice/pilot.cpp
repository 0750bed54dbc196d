#include "pilot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "box_tree_bound.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/vocabulary/ray_blocks.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/sim/technique/registry.hpp"
#include "other_techniques.hpp"
#include "usual_shape.hpp"

namespace detp::validate {
namespace {

double seconds(const Piloted& one) { return one.time.total(); }

/// usual_shape with the costs' p/u; where one of these is zero, with the usual one.
BoxTreeParameters usual_shape_of(const SearchSize& size, const Prices& prices) {
  const UnitCosts& costs = prices.costs[Technique::box_tree];
  const bool known = costs.leaf > 0 && costs.disc_test > 0;
  return usual_shape(size.rays, size.discs, known ? costs.leaf / costs.disc_test : usual_placing);
}

/// Looks for the fastest box tree: halves and doubles leaf and fan-out in turn, as long as that is faster.
class ShapeSearch {
 public:
  ShapeSearch(const sim::PilotedDiscs& discs, const SearchSize& size, const Prices& prices, bool for_replans)
      : discs_(discs), size_(size), prices_(prices), for_replans_(for_replans) {}

  std::vector<Piloted> run() {
    consider(usual_shape_of(size_, prices_));
    for (BoxTreeParameters before{}; !(before == best());) {
      before = best();
      walk(&BoxTreeParameters::leaf, 4, 1024);
      walk(&BoxTreeParameters::fan_out, 4, 64);
    }
    std::stable_sort(tried_.begin(), tried_.end(),
                     [](const Piloted& a, const Piloted& b) { return seconds(a) < seconds(b); });
    return std::move(tried_);
  }

 private:
  /// Returns true if the shape is the best so far, and was not tried before.
  bool consider(const BoxTreeParameters& shape) {
    const Candidate candidate{Technique::box_tree, shape};
    for (const Piloted& one : tried_)
      if (one.candidate == candidate) return false;
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
    const auto least = std::min_element(tried_.begin(), tried_.end(),
                                        [](const Piloted& a, const Piloted& b) { return seconds(a) < seconds(b); });
    return std::get<BoxTreeParameters>(least->candidate.parameters);
  }

  const sim::PilotedDiscs& discs_;
  const SearchSize& size_;
  const Prices& prices_;
  bool for_replans_;
  std::vector<Piloted> tried_;
};

/// Its tests are known. Of its hits, only the pilot's estimate is, or a closed form, which may be off by a factor of two.
Piloted brute_force(const SearchSize& size, double hits, double error_of_hits, const Prices& prices) {
  const auto counts_at = [=](double radius_ratio, double rays) {
    const double blocks = ray_blocks(rays, size.discs, Engine::simd).count();
    return Counts<double>{.loaded = rays,
                          .segments = size.segments ? rays : 0,
                          .visits = blocks * size.discs,
                          .disc_tests = rays * size.discs,
                          .hits = hits * rays / size.rays * radius_ratio * radius_ratio};
  };
  const Candidate candidate{Technique::brute_force, BruteForceParameters{}};
  Piloted found = priced(candidate, counts_at(1, size.rays), {.hits = error_of_hits}, prices);
  found.counts_at = counts_at;
  return found;
}

/// The usual shape, with a rough guess of its counts, from which the number of threads follows.
Piloted usual_box_tree(const SearchSize& size, const Prices& prices) {
  constexpr double culls_of_ray = 40;
  constexpr double leaves_of_ray = 5;
  const BoxTreeParameters shape = usual_shape_of(size, prices);
  const Counts<double> counts{.loaded = size.rays,
                              .segments = size.segments ? size.rays : 0,
                              .cull_tests = culls_of_ray * size.rays,
                              .disc_tests = leaves_of_ray * shape.leaf * size.rays,
                              .references = size.discs,
                              .placements = size.discs,
                              .sorted = size.discs};
  return priced({Technique::box_tree, shape}, counts, {}, prices);
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

/// Sorts by time, but with the choice first: the candidate that is fastest even if closed forms are off. Extrapolated
/// closed forms are never chosen. A box tree needs `preparing` less than its time, because its discs are sorted already.
void sort_by_time(std::vector<Piloted>& candidates, double preparing) {
  const auto cautious = [&](const Piloted& one) {
    if (!one.extrapolated.empty()) return std::numeric_limits<double>::infinity();
    const double prepared = one.candidate.technique == Technique::box_tree ? preparing : 0;
    return seconds(one) - prepared + (one.closed_form ? one.error : 0);
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Piloted& a, const Piloted& b) { return seconds(a) < seconds(b); });
  const auto choice = std::min_element(candidates.begin(), candidates.end(),
                                       [&](const Piloted& a, const Piloted& b) { return cautious(a) < cautious(b); });
  std::rotate(candidates.begin(), choice, choice + 1);
}

/// The time of a run in units of some 50 ns, roughly.
double work_of(double rays, double discs) { return discs + 4 * rays; }

/// Below this work, a pilot takes more than some 5 % of the run.
constexpr double least_work = 1e6;

/// At least five: with four, the spread between them says so little of its own accuracy that the stated error of counts is 1.3
/// times as large.
std::size_t subtrees_of(double rays, double discs) {
  return static_cast<std::size_t>(std::clamp(work_of(rays, discs) / 50'000, 5.0, 32.0));
}

}  // namespace

std::size_t pilot_size(double rays, double discs) {
  return static_cast<std::size_t>(std::clamp(work_of(rays, discs) / 600, 64.0, 2048.0));
}

std::vector<sim::Ray> pilot_sample(std::span<const sim::Ray> rays, std::size_t discs) {
  const std::size_t enough = pilot_size(static_cast<double>(rays.size()), static_cast<double>(discs));
  std::vector<sim::Ray> sample;
  for (const std::size_t ray : sim::stratified_sample(rays.size(), enough, 1, sim::Stream::pilot))
    sample.push_back(rays[ray]);
  return sample;
}

PilotChoice choose_by_pilot(const sim::Problem& problem, std::span<const sim::Ray> sample, double rays,
                            const Valid<CostTable>& costs, const PilotOptions& options) {
  const sim::DefaultFloatingPoint mode;
  if (sample.empty()) throw std::invalid_argument("a pilot needs at least one ray");
  require_count("number of rays", rays, 1, 1e18);
  if (!is_allowed(Technique::box_tree, options))
    throw std::invalid_argument("a pilot needs box-tree, which is disabled");
  if (!sim::PilotedDiscs::can_pilot(problem))
    throw std::invalid_argument("rays start too far from the discs for float kernels; a pilot needs them");
  if (costs.engine != Engine::simd) throw std::invalid_argument("a pilot counts for the simd engine, not for plain");
  sim::StopCheck(options.stop, "choosing").now();
  const sim::Stopwatch watch;
  const Prices prices{costs, sim::useful_threads(options.threads)};
  const SearchSize size{rays,
                        std::any_of(sample.begin(), sample.end(), [](const sim::Ray& ray) { return !ray.is_line(); }),
                        static_cast<double>(problem.discs().size())};
  PilotChoice found;
  const double preparing = prices({.placements = size.discs, .sorted = size.discs}, Technique::box_tree).time.total();
  if (is_allowed(Technique::brute_force, options)) {
    const double hits = options.expected_hits ? *options.expected_hits
                        : options.workload    ? model::expected_hits(*options.workload)
                                              : 0;
    const double error_of_hits = hits > 0 ? hits : size.rays * size.discs;  // nothing is known
    const Piloted brute = brute_force(size, hits, error_of_hits, prices);
    const double least = least_box_tree_seconds(problem, sample, size, preparing, seconds(brute), prices);
    if (seconds(brute) < least) {
      sim::Problem of_sample = problem;
      sim::set_rays(of_sample, sample);  // checks the sample, as a pilot does
      found.candidates = {brute};
      found.ruled_out = {{Technique::box_tree, least, true}};
      compare_others(problem, size, prices, options, found);
      found.pilot_seconds = watch.seconds();
      return found;
    }
  }
  if (options.only_choice && work_of(rays, size.discs) < least_work) {
    found.candidates = {usual_box_tree(size, prices)};
    found.predicted = false;
    found.pilot_seconds = watch.seconds();
    return found;
  }
  found.sampled_rays = sample.size();
  found.discs = std::make_shared<sim::PilotedDiscs>(
      problem,
      sim::stream::PilotRays{.sample = sample,
                             .all = rays,
                             .independent = options.independent_sample,
                             .hits = options.expected_hits,
                             .others = options.independent_sample ? std::span<const sim::Ray>()
                                       : options.others.empty()   ? problem.rays()
                                                                  : options.others},
      subtrees_of(rays, size.discs), sim::RunOptions{.stop = options.stop, .threads = options.threads});
  found.sort_seconds = found.discs->sort_seconds();
  found.candidates = ShapeSearch(*found.discs, size, prices, options.for_replans).run();
  const auto add = [&](auto&& more) {
    more();
    sort_by_time(found.candidates, preparing);
  };
  if (is_allowed(Technique::brute_force, options))
    add([&] {
      const Piloted& tree = found.choice();
      found.candidates.push_back(brute_force(size, tree.counts.hits, tree.counts_error.hits, prices));
    });
  add([&] { compare_others(problem, size, prices, options, found); });
  found.pilot_seconds = watch.seconds() - found.sort_seconds;
  return found;
}

PilotChoice choose_by_pilot(const sim::Problem& problem, const Valid<CostTable>& costs, const PilotOptions& options) {
  const sim::DefaultFloatingPoint mode;
  const sim::Stopwatch watch;
  const std::span<const sim::Ray> rays = problem.rays();
  const std::size_t discs = problem.discs().size();
  // Without a pilot, one ray stands for all: nothing is culled.
  const bool piloted =
      !options.only_choice || work_of(static_cast<double>(rays.size()), static_cast<double>(discs)) >= least_work;
  const std::vector<sim::Ray> sample =
      pilot_sample(piloted ? rays : rays.first(std::min<std::size_t>(1, rays.size())), discs);
  const double sampling = watch.seconds();
  PilotChoice found = choose_by_pilot(problem, sample, static_cast<double>(rays.size()), costs, options);
  found.pilot_seconds += sampling;
  return found;
}

PilotChoice choose_again(const PilotChoice& pilot, const sim::Problem& problem, double radius_ratio, double rays,
                         const Valid<CostTable>& costs, const PilotOptions& options) {
  const sim::DefaultFloatingPoint mode;
  require_positive("ratio of the radii", radius_ratio);
  require_count("number of rays", rays, 1, 1e18);
  const Prices prices{costs, sim::useful_threads(options.threads)};
  const auto discs = static_cast<double>(problem.discs().size());
  const double preparing = prices({.placements = discs, .sorted = discs}, Technique::box_tree).time.total();
  PilotChoice found;
  for (const Piloted& one : pilot.candidates)
    if (one.counts_at) found.candidates.push_back(priced(one.candidate, one.counts_at(radius_ratio, rays), {}, prices));
  if (found.candidates.empty()) throw std::invalid_argument("a choice without a pilot needs counts of an earlier one");
  const auto is_brute_force = [](const Piloted& one) { return one.candidate.technique == Technique::brute_force; };
  const auto brute = std::find_if(found.candidates.begin(), found.candidates.end(), is_brute_force);
  if (brute != found.candidates.end() && seconds(*brute) < preparing) {
    found.candidates = {Piloted(*brute)};
    found.ruled_out = {{Technique::box_tree, preparing, true}};
  } else if (std::all_of(found.candidates.begin(), found.candidates.end(), is_brute_force)) {
    found.unexamined = {Technique::box_tree};
  }
  sort_by_time(found.candidates, preparing);
  PilotOptions of_others = options;
  for (const Technique technique : pilot.unexamined) {
    of_others.disabled.push_back(technique);
    found.unexamined.push_back(technique);
  }
  compare_others(problem, {rays, found.choice().counts.segments > 0, discs}, prices, of_others, found);
  sort_by_time(found.candidates, preparing);
  return found;
}

std::unique_ptr<sim::Index> build_choice(PilotChoice& choice, const sim::Problem& problem,
                                         const sim::RunOptions& options) {
  const Candidate& candidate = choice.choice().candidate;
  if (!choice.discs || candidate.technique != Technique::box_tree) return sim::prepare(problem, candidate, options);
  const auto discs = std::exchange(choice.discs, nullptr);
  return std::move(*discs).build(problem, std::get<BoxTreeParameters>(candidate.parameters), options);
}

}  // namespace detp::validate
