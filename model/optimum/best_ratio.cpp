#include "best_ratio.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <queue>
#include <vector>

#include "detp/model/lines/line_measure.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/model/sphere_cache/step_pieces.hpp"

namespace detp::model {
namespace {

/// T of the sphere cache at one Q for all numbers of spheres, in one pass from the outside in.
class CacheTimes {
 public:
  CacheTimes(const Valid<Workload>& workload, const Valid<UnitCosts>& costs) : workload_(workload), costs_(costs) {
    const double blocks = blocks_of(workload.rays, workload.samples);
    costs_.cull *= blocks;
    costs_.visit *= blocks;
    costs_.ray = costs_.hit = costs_.far = costs_.start = 0;
  }

  [[nodiscard]] std::int64_t evaluated_spheres() const { return evaluated_spheres_; }

  /// T without spheres; Q does not matter.
  [[nodiscard]] BestRatio without_spheres() const {
    return {published_ratio, 0, price(sphere_cache_counts(workload_, {published_ratio, 0}), costs_).total()};
  }

  /// T with k spheres.
  [[nodiscard]] double at(double ratio, std::int64_t k) const {
    if (k > summed_one_by_one) {
      evaluated_spheres_ += summed_one_by_one;
      return price(sphere_cache_counts(workload_, {ratio, k}), costs_).total();
    }
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
      ++evaluated_spheres_;
      spheres += level.rebuilds * (level.tests * costs_.cull_test + level.listed * costs_.listed + costs_.cull);
      return visit(level.i, spheres + workload_.samples * level.served * costs_.disc_test, spheres);
    });
  }

  const Valid<Workload>& workload_;
  UnitCosts costs_;  ///< multiplied by the number of blocks: each block makes lists and visits discs
  mutable std::int64_t evaluated_spheres_ = 0;
};

/// ln(ln 1/Q), the coordinate of the search. The local minima of T are spaced about evenly in this coordinate: if ln Q
/// changes by δ, ln r_i changes by i δ, and there are ln(d/r₀)/ln Q spheres.
double search_coordinate(double ratio) { return std::log(-std::log(ratio)); }

/// The first ratios of a search, including all steps Q_j with j <= most_spheres.
std::vector<double> first_ratios(const StepPieces& pieces, std::int64_t most_spheres) {
  constexpr int parts = 128;
  const double from = search_coordinate(least_ratio);
  const double to = search_coordinate(most_ratio);
  std::vector<double> ratios;
  for (int i = 0; i <= parts; ++i) ratios.push_back(std::exp(-std::exp(from + (to - from) * i / parts)));
  for (std::int64_t j = 1; j <= most_spheres && pieces.above(j) <= most_ratio; ++j)
    if (pieces.above(j) >= least_ratio) ratios.push_back(pieces.above(j));
  std::sort(ratios.begin(), ratios.end());
  return ratios;
}

/// Halves the intervals that may hold a better ratio, the most promising first, and then refines the remaining minima.
class Search {
 public:
  /// Searches numbers of spheres up to most_spheres; if it is 0, the function passed to `run` fixes the number.
  /// `spheres` is the largest number of spheres evaluated for one ratio.
  Search(const CacheTimes& times, const StepPieces& pieces, std::int64_t most_spheres, std::int64_t spheres)
      : times_(times),
        pieces_(pieces),
        most_spheres_(most_spheres),
        most_evaluated_spheres_(most_evaluated_spheres * (std::clamp<std::int64_t>(spheres, 40, 4000) / 40)) {}

  /// The best result of evaluate(Q, time_limit) for Q between the first and the last of the ratios.
  template <class Evaluate>
  BestRatio run(const std::vector<double>& ratios, const Evaluate& evaluate) {
    for (const double ratio : ratios) add(evaluate(ratio, time_limit()));
    const std::vector<BestRatio> first = points_;
    for (std::size_t i = 1; i < first.size(); ++i) split_later(first[i - 1], first[i]);
    while (!intervals_.empty() && intervals_.top().lower_bound < best_.time &&
           times_.evaluated_spheres() < most_evaluated_spheres_ / 4 * 3) {
      const Interval interval = intervals_.top();
      intervals_.pop();
      const BestRatio middle = evaluate(0.5 * (interval.left.ratio + interval.right.ratio), time_limit());
      add(middle);
      split_later(interval.left, middle);
      split_later(middle, interval.right);
    }
    narrow_down();
    best_.evaluated_spheres = times_.evaluated_spheres();
    return best_;
  }

 private:
  struct Interval {
    BestRatio left;
    BestRatio right;
    double lower_bound;  ///< for T in the interval, if T is no steeper than `steepness`

    bool operator<(const Interval& other) const { return lower_bound > other.lower_bound; }
  };

  /// Assumed largest relative slope of T over ln(ln 1/Q). Sufficient in all cases tried, but not proved.
  static constexpr double steepness = 5;
  static constexpr double narrowest = 2.5e-4;  ///< width of the narrowest interval, in ln(ln 1/Q)
  static constexpr double next_to = 1.0005;    ///< minima with T up to this factor above the best are refined
  static constexpr std::int64_t evaluations_at_once = 60;  ///< largest number of evaluations by Brent's method

  [[nodiscard]] double time_limit() const { return best_.spheres > 0 ? 1.2 * best_.time : HUGE_VAL; }

  void add(const BestRatio& point) {
    if (point.spheres == 0) return;
    points_.push_back(point);
    if (best_.spheres == 0 || point.time < best_.time) best_ = point;
  }

  void split_later(const BestRatio& left, const BestRatio& right) {
    const double width = search_coordinate(left.ratio) - search_coordinate(right.ratio);
    if (width <= narrowest || left.spheres == 0 || right.spheres == 0) return;
    intervals_.push({left, right, std::min(left.time, right.time) * (1 - steepness * width / 2)});
  }

  void narrow_down() {
    std::sort(points_.begin(), points_.end(), [](const BestRatio& a, const BestRatio& b) { return a.ratio < b.ratio; });
    const std::size_t last = points_.empty() ? 0 : points_.size() - 1;
    const double near_best = next_to * best_.time;
    std::vector<std::size_t> minima;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (points_[i].time <= std::min(points_[i > 0 ? i - 1 : 0].time, points_[std::min(i + 1, last)].time))
        minima.push_back(i);
    std::stable_sort(minima.begin(), minima.end(),
                     [&](std::size_t a, std::size_t b) { return points_[a].time < points_[b].time; });
    for (const std::size_t i : minima) {
      const std::int64_t to_compare_stops = 3 * (points_[i].spheres + 1);
      if (points_[i].time > near_best || times_.evaluated_spheres() + to_compare_stops > most_evaluated_spheres_) break;
      for (const std::int64_t k : stops_around(points_[i]))
        minimise(std::max(points_[i > 0 ? i - 1 : 0].ratio, pieces_.above(k)), points_[std::min(i + 1, last)].ratio, k);
    }
  }

  /// The point's number of spheres k, and k - 1 and k + 1 if their T is about as small. Only k if the number is fixed.
  [[nodiscard]] std::vector<std::int64_t> stops_around(const BestRatio& point) const {
    std::vector<std::int64_t> stops{point.spheres};
    for (const std::int64_t k : {point.spheres - 1, point.spheres + 1})
      if (k >= 1 && k <= most_spheres_ && times_.at(point.ratio, k) <= next_to * best_.time) stops.push_back(k);
    return stops;
  }

  /// Searches for the smallest T with k spheres for Q from low to high. Between two points of the search there may be
  /// several kinks, and so several minima.
  void minimise(double low, double high, std::int64_t k) {
    constexpr int parts = 16;
    if (!(low < high) || (most_evaluated_spheres_ - times_.evaluated_spheres()) / k <= parts) return;
    const auto ratio = [&](int i) { return low + (high - low) * i / parts; };
    std::array<double, parts + 1> times{};
    for (int i = 0; i <= parts; ++i) times[static_cast<std::size_t>(i)] = times_.at(ratio(i), k);
    const double bound_factor = 1 - steepness * (search_coordinate(low) - search_coordinate(high)) / parts / 2;
    for (int i = 0; i <= parts; ++i) {
      const int left = std::max(i - 1, 0);
      const int right = std::min(i + 1, parts);
      const double time = times[static_cast<std::size_t>(i)];
      const double beside = std::min(times[static_cast<std::size_t>(left)], times[static_cast<std::size_t>(right)]);
      if (time <= beside && time * bound_factor < best_.time) follow(ratio(left), ratio(right), k);
    }
  }

  /// Brent's method in a coordinate from -1 to 1. So its tolerance is 4e-6 of the width, even at a kink.
  void follow(double low, double high, std::int64_t k) {
    const std::int64_t evaluations_left = (most_evaluated_spheres_ - times_.evaluated_spheres()) / k - 1;
    if (evaluations_left < 2) return;
    const auto ratio = [&](double place) { return low + (high - low) * (place + 1) / 2; };
    auto evaluations = static_cast<std::uintmax_t>(std::min(evaluations_at_once, evaluations_left));
    const auto [place, time] = boost::math::tools::brent_find_minima([&](double y) { return times_.at(ratio(y), k); },
                                                                     -1.0, 1.0, 19, evaluations);
    if (time < best_.time) best_ = {ratio(place), k, time};
  }

  const CacheTimes& times_;
  const StepPieces& pieces_;
  std::int64_t most_spheres_;
  std::int64_t most_evaluated_spheres_;
  std::priority_queue<Interval> intervals_;
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
  return costs.ray * workload.rays + costs.hit * expected_hits(workload) + costs.far * far_discs({.visits = visits}) +
         costs.start;
}

BestRatio best_ratio_and_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                              std::int64_t most_spheres) {
  require_count("largest number of spheres", static_cast<double>(most_spheres), 1, 9e18);
  const CacheTimes times(workload, costs);
  if (!holds_a_disc(workload, most_ratio)) return times.without_spheres();
  const StepPieces pieces(workload);
  const BestRatio best =
      Search(times, pieces, most_spheres, most_spheres)
          .run(first_ratios(pieces, std::min<std::int64_t>(most_spheres, 40)), [&](double ratio, double time_limit) {
            return times.best_stop(ratio, last_stop(workload, ratio, most_spheres), time_limit);
          });
  return best.spheres > 0 ? best : times.without_spheres();
}

BestRatio good_ratio_and_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs) {
  return good_ratio_below(workload, costs, HUGE_VAL);
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

BestRatio better_ratio_and_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, const BestRatio& good) {
  constexpr std::size_t parts = 176;
  constexpr std::size_t refined = 6;  // number of minima
  if (good.spheres == 0) return good;
  const CacheTimes times(workload, costs);
  const double from = search_coordinate(most_ratio);
  const double step = (search_coordinate(least_ratio) - from) / (parts - 1);
  const auto ratio_at = [&](double place) { return std::exp(-std::exp(from + place * step)); };
  std::array<BestRatio, parts> points;
  BestRatio best = good;
  for (std::size_t i = 0; i < parts; ++i) {
    const double ratio = ratio_at(static_cast<double>(i));
    points[i] = times.best_stop(ratio, std::max<std::int64_t>(1, last_stop(workload, ratio, 40)), 1.1 * best.time);
    if (points[i].time < best.time) best = points[i];
  }
  std::vector<std::size_t> minima;
  for (std::size_t i = 0; i < parts; ++i)
    if (points[i].time <= points[i > 0 ? i - 1 : 0].time && points[i].time <= points[std::min(i + 1, parts - 1)].time)
      minima.push_back(i);
  std::stable_sort(minima.begin(), minima.end(),
                   [&](std::size_t a, std::size_t b) { return points[a].time < points[b].time; });
  minima.resize(std::min(minima.size(), refined));
  for (const std::size_t i : minima) {
    const auto middle = static_cast<double>(i);
    const std::int64_t k = points[i].spheres;
    std::uintmax_t evaluations = 10;
    const auto [place, time] = boost::math::tools::brent_find_minima(
        [&](double y) { return times.at(ratio_at(y), k); }, std::max(middle - 1, 0.0),
        std::min(middle + 1, parts - 1.0), 12, evaluations);
    if (time < best.time) best = {ratio_at(place), k, time};
  }
  best.evaluated_spheres = times.evaluated_spheres();
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
  std::vector<double> ratios = first_ratios(pieces, 0);
  std::erase_if(ratios, [&](double ratio) { return ratio <= pieces.above(spheres); });
  ratios.insert(ratios.begin(), std::min(most_ratio, std::max(least_ratio, pieces.above(spheres))));
  return Search(times, pieces, 0, spheres).run(ratios, [&](double ratio, double) {
    return BestRatio{ratio, spheres, times.at(ratio, spheres)};
  });
}

}  // namespace detp::model
