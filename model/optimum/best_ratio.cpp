#include "best_ratio.hpp"

#include <fmt/format.h>
#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "best_published_ratio.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/model/sphere_cache/step_pieces.hpp"

namespace detp::model {
namespace {

/// T of the sphere cache at one Q for all numbers of spheres, in one pass from the outside in.
class CacheTimes {
 public:
  CacheTimes(const Valid<Workload>& workload, const Valid<UnitCosts>& costs)
      : workload_(workload), costs_(costs), lists_(far_lists({.culls = 1, .sorted = workload.samples})) {
    const double blocks = blocks_of(workload.rays, workload.samples);
    costs_.cull *= blocks;
    costs_.visit *= blocks;
    costs_.ray = costs_.hit = costs_.far = costs_.start = 0;
  }

  /// T without spheres; Q does not matter.
  [[nodiscard]] BestRatio without_spheres() const {
    return {published_ratio, 0, price(sphere_cache_counts(workload_, {published_ratio, 0}), costs_).total()};
  }

  /// T with k spheres.
  [[nodiscard]] double at(double ratio, std::int64_t k) const {
    if (k > summed_one_by_one) return price(sphere_cache_counts(workload_, {ratio, k}), costs_).total();
    double time = 0;
    pass(ratio, k, [&](std::int64_t, double with_discs, double) {
      time = with_discs;
      return true;
    });
    return time;
  }

  /// The fastest number of spheres among 1 … last; spheres = 0 if last = 0. T without disc tests grows with the number.
  /// Stops when this part of T reaches the best T so far, or `time_limit`. In the second case the result is slower than
  /// `time_limit`, and may not be the fastest.
  [[nodiscard]] BestRatio best_stop(double ratio, std::int64_t last, double time_limit) const {
    BestRatio best{ratio, 0, 0};
    if (last >= 1)
      pass(ratio, last, [&](std::int64_t i, double with_discs, double spheres) {
        if (best.spheres == 0 || with_discs < best.time) best = {ratio, i, with_discs};
        return spheres < std::min(time_limit, best.time);
      });
    return best;
  }

 private:
  static constexpr std::int64_t summed_one_by_one = 4096;  // larger numbers are summed in groups

  /// Calls visit(i, T with i spheres, T without disc tests) until it returns false.
  template <class Visit>
  void pass(double ratio, std::int64_t last, const Visit& visit) const {
    double spheres = (costs_.sort + costs_.visit) * workload_.samples;
    for_each_level(workload_, {ratio, last, SampleOrder::lebesgue}, [&](const SphereLevel& level) {
      spheres +=
          level.rebuilds * (level.tests * costs_.cull_test + level.listed * costs_.listed + lists_ * costs_.cull);
      return visit(level.i, spheres + workload_.samples * level.served * costs_.disc_test, spheres);
    });
  }

  const Valid<Workload>& workload_;
  UnitCosts costs_;  ///< multiplied by the number of blocks: each block makes lists and visits discs
  double lists_;     ///< by which far_lists multiplies lists
};

/// ln(ln 1/Q), the coordinate of the search. The local minima of T are spaced about evenly in this coordinate: if ln Q
/// changes by δ, ln r_i changes by i δ, and there are ln(d/r₀)/ln Q spheres.
double search_coordinate(double ratio) { return std::log(-std::log(ratio)); }

double ratio_at(double coordinate) { return std::exp(-std::exp(coordinate)); }

/// The best result of evaluate(Q, time limit) for Q from `least` to most_ratio.
template <class Evaluate>
class Search {
 public:
  Search(const CacheTimes& times, const StepPieces& pieces, double least, const Evaluate& evaluate)
      : times_(times), pieces_(pieces), evaluate_(evaluate) {
    constexpr int parts = 64;
    const double from = search_coordinate(least);  // few spheres: soon there is a time limit
    const double to = search_coordinate(most_ratio);
    for (int i = 0; i <= parts; ++i) add(from + (to - from) * i / parts);
    for (const double excess : {0.2, 0.1, 0.05}) halve_intervals((1 + excess) * best_.time);
    refine_minima();
  }

  [[nodiscard]] const BestRatio& best() const { return best_; }

 private:
  void add(double coordinate) {
    const BestRatio point = evaluate_(ratio_at(coordinate), best_.spheres > 0 ? 1.1 * best_.time : HUGE_VAL);
    if (point.spheres == 0) return;
    points_.push_back(point);
    if (best_.spheres == 0 || point.time < best_.time) best_ = point;
  }

  /// Halves the intervals that have an end with a smaller time than this.
  void halve_intervals(double time) {
    const std::size_t ends = points_.size();
    for (std::size_t i = 1; i < ends; ++i)
      if (std::min(points_[i - 1].time, points_[i].time) < time)
        add((search_coordinate(points_[i - 1].ratio) + search_coordinate(points_[i].ratio)) / 2);
    std::sort(points_.begin(), points_.end(), [](const BestRatio& a, const BestRatio& b) { return a.ratio < b.ratio; });
  }

  /// Around each of the lowest minima, Brent's method follows T with the number of spheres of the minimum.
  void refine_minima() {
    constexpr std::size_t most = 6;
    const std::size_t last = points_.size() - 1;
    std::vector<std::size_t> minima;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (points_[i].time <= std::min(points_[i > 0 ? i - 1 : 0].time, points_[std::min(i + 1, last)].time))
        minima.push_back(i);
    std::stable_sort(minima.begin(), minima.end(),
                     [&](std::size_t a, std::size_t b) { return points_[a].time < points_[b].time; });
    minima.resize(std::min(minima.size(), most));
    for (const std::size_t i : minima)
      follow(points_[i > 0 ? i - 1 : 0].ratio, points_[std::min(i + 1, last)].ratio, points_[i].spheres);
  }

  void follow(double low, double high, std::int64_t k) {
    low = std::max(low, pieces_.above(k));  // below, the smallest sphere would not hold a disc
    if (!(low < high)) return;
    std::uintmax_t evaluations = 10;
    const auto [ratio, time] =
        boost::math::tools::brent_find_minima([&](double q) { return times_.at(q, k); }, low, high, 20, evaluations);
    if (time < best_.time) best_ = {ratio, k, time};
  }

  const CacheTimes& times_;
  const StepPieces& pieces_;
  const Evaluate& evaluate_;
  std::vector<BestRatio> points_;
  BestRatio best_;
};

/// The largest k with r_k >= d, at most `most`. If Q is just below a step of k (ln Q within 1e-12, relative, of its
/// value at the step), the result is 1 too large.
std::int64_t last_stop(const Valid<Workload>& workload, double ratio, std::int64_t most) {
  const double exact = std::log(workload.disc_radius / workload.sphere_radius) / std::log(ratio);
  return static_cast<std::int64_t>(std::min(static_cast<double>(most), std::floor(exact * (1 + 1e-12))));
}

bool holds_a_disc(const Valid<Workload>& workload, double ratio) {
  return workload.disc_radius < ratio * workload.sphere_radius;
}

}  // namespace

double time_at_any_ratio(const Valid<Workload>& workload, const Valid<UnitCosts>& costs) {
  const double visits = blocks_of(workload.rays, workload.samples) * workload.samples;
  return costs.ray * workload.rays + costs.hit * expected_hits(workload) +
         costs.far * far_discs({.visits = visits, .sorted = workload.samples}) + costs.start;
}

BestRatio best_ratio_and_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                              std::int64_t most_spheres) {
  require_count("largest number of spheres", static_cast<double>(most_spheres), 1, 9e18);
  const CacheTimes times(workload, costs);
  if (!holds_a_disc(workload, most_ratio)) return times.without_spheres();
  const auto evaluate = [&](double ratio, double time_limit) {
    return times.best_stop(ratio, last_stop(workload, ratio, most_spheres), time_limit);
  };
  return Search(times, StepPieces(workload), least_ratio, evaluate).best();
}

BestRatio good_ratio_below(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, double time) {
  constexpr double most_excess = 3;  // of T at any of these ratios
  const CacheTimes times(workload, costs);
  if (!holds_a_disc(workload, most_ratio)) return times.without_spheres();
  BestRatio best;
  // The ratios were chosen one after another. Each minimises the mean square of the excess that then remains: of the
  // smallest T at the ratios chosen so far over the best T.
  for (const double ratio : {0.575, 0.47, 0.765, 0.425, 0.49, 0.6, 0.455, 0.635}) {
    const BestRatio stop = times.best_stop(ratio, std::max<std::int64_t>(1, last_stop(workload, ratio, 40)), HUGE_VAL);
    if (best.spheres == 0 || stop.time < best.time) best = stop;
    if (best.time > most_excess * time) break;
  }
  return best;
}

BestRatio best_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, RadiusRatio ratio) {
  constexpr std::int64_t most = 4096;
  const CacheTimes times(workload, costs);
  const std::int64_t last = sphere_count(Form::corrected, ratio, {workload.disc_radius}, {workload.sphere_radius});
  return last == 0 ? times.without_spheres() : times.best_stop(ratio.value, std::min(last, most), HUGE_VAL);
}

BestRatio best_ratio_for(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, std::int64_t spheres) {
  require_count("number of spheres", static_cast<double>(spheres), 0, 9e18);
  const CacheTimes times(workload, costs);
  if (spheres == 0 || !holds_a_disc(workload, 1)) return times.without_spheres();
  const StepPieces pieces(workload);
  const double least = std::clamp(pieces.above(spheres), least_ratio, most_ratio);
  const auto evaluate = [&](double ratio, double) { return BestRatio{ratio, spheres, times.at(ratio, spheres)}; };
  return Search(times, pieces, least, evaluate).best();
}

std::int64_t own_spheres(const Workload& workload, Form form, RadiusRatio ratio) {
  return sphere_count(form, ratio, {workload.disc_radius}, {workload.sphere_radius});
}

SphereStops sphere_stops(const Workload& workload, const UnitCosts& costs, Form form, RadiusRatio ratio) {
  const std::int64_t max = own_spheres(workload, form, ratio);
  if (max == 0) return {};
  return {max, form == Form::published ? published::best_stop(workload, costs, ratio)
                                       : best_stop(workload, costs, ratio).spheres};
}

double optimal_ratio(double dimension) {
  if (!(dimension >= 1 && dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 1 to 3 (got {})", dimension));
  const long double beyond = dimension - 2;
  return static_cast<double>(std::exp(beyond == 0 ? -0.5L : -std::log1p(beyond / 2) / beyond));
}

}  // namespace detp::model
