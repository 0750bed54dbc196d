#include "accuracy_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"

namespace detp::validate {
namespace {

constexpr int scales_tried = 49;
constexpr double share_for_bias = 0.98;  // a total target leaves at least 2 % of its square to noise

double square_of(double x) { return x * x; }

double root(double square) { return std::sqrt(std::max(0.0, square)); }

/// The mean of a square that is at least 0, if its estimate is normal: one that is 0 ± s may be s as well, and is 0.8 s in the mean.
double expected_square(const Estimate& square) {
  const double error = square.standard_error;
  if (!(error > 0 && std::isfinite(error))) return std::max(0.0, square.mean);
  const double x = square.mean / error;
  if (x < -6)
    return -error / x * (1 - 2 / (x * x) + 10 / std::pow(x, 4));  // the formula below without cancellation, to 0.2 %
  const double above = 0.5 * std::erfc(-x / std::numbers::sqrt2);
  return square.mean + error * std::exp(-0.5 * x * x) / (above * std::sqrt(2 * std::numbers::pi));
}

/// One estimator with what the pilot found of it.
class Ways {
 public:
  Ways(const AccuracyPilot& pilot, const EstimatorPilot& own, double most_rays)
      : pilot_(pilot), own_(own), most_rays_(most_rays), spread_(interval_width(0.05, 1, static_cast<int>(own.runs))) {
    const double least = own.settings.front().scale;
    const double most = own.settings.back().scale;
    const int count = own.settings.size() == 1 ? 1 : scales_tried;
    for (int i = 0; i < count; ++i)
      scales_.push_back(count == 1 ? least : least * std::pow(most / least, static_cast<double>(i) / (count - 1)));
  }

  [[nodiscard]] AccuracyPoint at(double scale, double rays) const {
    rays = std::clamp(std::ceil(rays), gathers() ? 2.0 : 1.0, most_rays_);
    const Estimate bias = own_.bias_squared(scale);
    const double noise_squared = own_.noise_squared(scale, rays);
    const bool radius = uses_radius(own_.estimator);
    AccuracyPoint point{
        .estimator = own_.estimator, .rays = rays, .photons = gathers() ? 0 : rays * pilot_.photons_per_ray};
    if (radius) point.radius = scale;
    if (own_.estimator == sim::Estimator::nearest)
      point.nearest = static_cast<int>(std::clamp(std::round(scale * rays), 3.0, 1e9));
    const double noise = std::sqrt(noise_squared);
    const double wide = std::exp(0.5 * spread_ * own_.noise_squared_error(scale));
    point.noise = {noise, noise / wide, noise * wide};
    const double spread = spread_ * bias.standard_error;
    point.bias = {root(bias.mean), root(bias.mean - spread), root(bias.mean + spread)};
    point.mean_bias = own_.mean_bias(scale);
    const double expected = expected_square(bias);
    const double square = noise_squared + expected;
    const double down =
        std::hypot(noise_squared - square_of(point.noise.low), expected - std::max(0.0, bias.mean - spread));
    const double up = std::hypot(square_of(point.noise.high) - noise_squared,
                                 std::max(0.0, std::max(0.0, bias.mean + spread) - expected));
    point.total = {root(square), root(square - down), root(square + up)};
    point.noise_weak = own_.rare_photons(scale) < enough_rare_photons;
    point.trace_seconds = gathers() ? 0 : pilot_.trace.at(rays);
    const GrowingSeconds seconds = seconds_of(scale);
    point.seconds = seconds.at(rays);
    // The noise's share of total² is that of d ln total / d ln rays = -1/2 noise²/total².
    const double seconds_slope = (seconds.per_ray + 2 * seconds.per_ray_squared * rays) * rays / point.seconds;
    const auto slope = [&](double total) { return -0.5 * std::min(1.0, square_of(noise / total)) / seconds_slope; };
    point.slope = {slope(point.total.value), slope(std::max(noise, point.total.low)), slope(point.total.high)};
    return point;
  }

  /// Nothing if no setting and number of rays reach the target.
  [[nodiscard]] std::optional<AccuracyPoint> reach(const AccuracyTarget& target) const {
    if (target.kind == AccuracyTarget::Kind::seconds) return best_in(target.value);
    const double square = square_of(target.value);
    if (target.kind == AccuracyTarget::Kind::total)
      return best(
          [&](double scale) {
            const double bias = expected_square(own_.bias_squared(scale));
            return bias > share_for_bias * target.value * target.value ? std::numeric_limits<double>::infinity()
                                                                       : own_.noise_squared(scale, 1) / (square - bias);
          },
          [](const AccuracyPoint& a, const AccuracyPoint& b) { return a.seconds < b.seconds; });
    // the largest setting with a bias below the noise; else the one with the least bias
    return best([&](double scale) { return own_.noise_squared(scale, 1) / square; },
                [&](const AccuracyPoint& a, const AccuracyPoint& b) {
                  const bool below = a.bias.value <= target.value;
                  if (below != (b.bias.value <= target.value)) return below;
                  return below ? a.seconds <= b.seconds : a.bias.value < b.bias.value;
                });
  }

  /// The setting with the least total error in that time.
  [[nodiscard]] AccuracyPoint best_in(double seconds) const {
    return *best([&](double scale) { return std::min(seconds_of(scale).rays_in(seconds), most_rays_); },
                 [](const AccuracyPoint& a, const AccuracyPoint& b) { return a.total.value < b.total.value; });
  }

  [[nodiscard]] double least_bias() const { return root(expected_square(own_.bias_squared(least_biased()))); }

  /// The setting of the least bias, with so many rays that noise adds a twentieth to the square.
  [[nodiscard]] AccuracyPoint nearest_to_floor() const {
    constexpr double share_of_noise = 0.05;
    const double scale = least_biased();
    const double bias = expected_square(own_.bias_squared(scale));
    return at(scale, bias > 0 ? own_.noise_squared(scale, 1) / (share_of_noise * bias) : most_rays_);
  }

 private:
  [[nodiscard]] double least_biased() const {
    return *std::ranges::min_element(scales_, {},
                                     [&](double scale) { return expected_square(own_.bias_squared(scale)); });
  }

  [[nodiscard]] bool gathers() const { return own_.estimator == sim::Estimator::gather; }

  /// Tracing included.
  [[nodiscard]] GrowingSeconds seconds_of(double scale) const {
    return gathers() ? own_.seconds(scale) : pilot_.trace + own_.seconds(scale);
  }

  /// The best of the settings tried, each with the rays that it needs; none that needs more than there may be.
  template <class Rays, class Better>
  [[nodiscard]] std::optional<AccuracyPoint> best(const Rays& rays_at, const Better& better) const {
    std::optional<AccuracyPoint> found;
    for (const double scale : scales_) {
      const double rays = rays_at(scale);
      if (rays > most_rays_) continue;
      const AccuracyPoint point = at(scale, rays);
      if (!found || better(point, *found)) found = point;
    }
    return found;
  }

  const AccuracyPilot& pilot_;
  const EstimatorPilot& own_;
  double most_rays_;
  double spread_;  ///< half width of an interval of 95 %, in standard errors
  std::vector<double> scales_;
};

/// A bound of the light that gather misses, if it is above a tenth of the target; of a time nothing.
std::optional<double> missed_too_much(const EstimatorPilot& own, const AccuracyTarget& target) {
  constexpr double tolerated = 0.1;
  if (own.estimator != sim::Estimator::gather || target.kind == AccuracyTarget::Kind::seconds) return std::nullopt;
  const Estimate& missed = own.settings.front().bias_squared;
  const double bound = root(missed.mean + interval_width(0.05, 1, static_cast<int>(own.runs)) * missed.standard_error);
  return bound > tolerated * target.value ? std::optional(bound) : std::nullopt;
}

bool is_tied(const AccuracyPoint& a, const AccuracyPoint& b) {
  return a.seconds < clearly_slower * b.seconds && b.seconds < clearly_slower * a.seconds;
}

/// Of ways about as fast as the first one, that with the least total error comes first.
template <class Worse>
void take_the_best_of_ties(std::vector<AccuracyPoint>& ways, const Worse& worse) {
  auto best = ways.begin();
  for (auto way = ways.begin(); way != ways.end(); ++way)
    if (is_tied(*way, ways.front()) && worse(*way) == worse(ways.front()) &&
        std::pair(way->total.value, way->total.high) < std::pair(best->total.value, best->total.high))
      best = way;
  std::rotate(ways.begin(), best, best + 1);
}

/// In place of the answer: what has clearly less total error in its time, and no more noise than asked for.
void take_what_is_better(AccuracyPlan& plan, const AccuracyPilot& pilot,
                         const std::vector<const EstimatorPilot*>& allowed, double most_rays) {
  constexpr double clearly = 0.98;
  std::optional<AccuracyPoint> better;
  for (const EstimatorPilot* own : allowed) {
    const AccuracyPoint point = Ways(pilot, *own, most_rays).best_in(plan.answer.seconds);
    const double least = clearly * (better ? better->total.value : plan.answer.total.value);
    if (point.estimator != plan.answer.estimator && reaches(point, plan.target) && point.total.value < least)
      better = point;
  }
  if (!better) return;
  const auto same = std::ranges::find(plan.rivals, better->estimator, &AccuracyPoint::estimator);
  if (same != plan.rivals.end()) plan.rivals.erase(same);
  plan.rivals.insert(plan.rivals.begin(), plan.answer);
  plan.answer = *better;
}

void mark_frontier(std::vector<AccuracyPoint>& points) {
  for (AccuracyPoint& one : points)
    one.on_frontier = std::ranges::none_of(points, [&](const AccuracyPoint& other) {
      return other.seconds <= one.seconds && other.total.high < one.total.low;
    });
}

}  // namespace

std::string_view name(AccuracyTarget::Kind kind) {
  using enum AccuracyTarget::Kind;
  return kind == noise ? "noise" : kind == total ? "error" : "seconds";
}

void check(const AccuracyTarget& target, double most_rays) {
  if (target.kind == AccuracyTarget::Kind::seconds)
    require_positive("time budget", target.value);
  else
    require_ratio("target error", target.value);
  require_count("number of rays", std::floor(most_rays), 1, 1e18);
}

bool reaches(const AccuracyPoint& point, const AccuracyTarget& target) {
  constexpr double rounding = 1.001;
  if (target.kind == AccuracyTarget::Kind::seconds) return true;
  return (target.kind == AccuracyTarget::Kind::noise ? point.noise : point.total).value <= rounding * target.value;
}

AccuracyPlan plan_accuracy(const AccuracyPilot& pilot, const AccuracyTarget& target, double most_rays) {
  check(target, most_rays);
  AccuracyPlan plan;
  plan.target = target;
  std::vector<AccuracyPoint> reached;
  std::vector<AccuracyPoint> nearest;  // to the target, of those that do not reach it
  plan.floor = std::numeric_limits<double>::infinity();
  std::vector<const EstimatorPilot*> allowed;
  for (const EstimatorPilot& own : pilot.estimators)
    if (const auto misses = missed_too_much(own, target))
      plan.gather_misses = misses;
    else
      allowed.push_back(&own);
  if (allowed.empty())
    throw std::invalid_argument(
        fmt::format("gather misses up to {:.2g} % of the light here", 100 * *plan.gather_misses));
  for (const EstimatorPilot* own : allowed) {
    const Ways ways(pilot, *own, most_rays);
    plan.floor = std::min(plan.floor, ways.least_bias());
    if (const auto point = ways.reach(target))
      reached.push_back(*point);
    else
      nearest.push_back(ways.nearest_to_floor());
  }
  // A noise target that one estimator meets with a bias below the noise is not answered by one with more bias.
  const auto worse = [&](const AccuracyPoint& one) {
    return target.kind == AccuracyTarget::Kind::noise && one.bias.value > target.value;
  };
  std::ranges::sort(reached, [&](const AccuracyPoint& a, const AccuracyPoint& b) {
    if (worse(a) != worse(b)) return worse(b);
    if (worse(a)) return a.total.value < b.total.value;
    return target.kind == AccuracyTarget::Kind::seconds ? a.total.value < b.total.value : a.seconds < b.seconds;
  });
  std::ranges::sort(nearest, {}, [](const AccuracyPoint& point) { return point.total.value; });
  plan.reached = !reached.empty();
  if (plan.reached && target.kind != AccuracyTarget::Kind::seconds) take_the_best_of_ties(reached, worse);
  std::vector<AccuracyPoint>& best = plan.reached ? reached : nearest;
  plan.answer = best.front();
  plan.rivals.assign(best.begin() + 1, best.end());
  if (plan.reached) plan.rivals.insert(plan.rivals.end(), nearest.begin(), nearest.end());
  if (plan.reached && target.kind == AccuracyTarget::Kind::noise) take_what_is_better(plan, pilot, allowed, most_rays);
  for (const AccuracyPoint& rival : plan.rivals)
    if (plan.reached && is_tied(rival, plan.answer) && !worse(rival) && reaches(rival, target))
      plan.ties.push_back(rival.estimator);
  for (const EstimatorPilot* own : allowed) {
    const Ways ways(pilot, *own, most_rays);
    for (int step = -3; step <= 3; ++step) {
      const AccuracyPoint point = ways.best_in(plan.answer.seconds * std::pow(4.0, step));
      const bool apart = plan.points.empty() || plan.points.back().estimator != point.estimator ||
                         point.rays > 2 * plan.points.back().rays;
      if (point.rays < most_rays && apart) plan.points.push_back(point);
    }
  }
  mark_frontier(plan.points);
  return plan;
}

std::vector<AccuracyPoint> points_around_answer(const AccuracyPlan& plan, std::size_t most) {
  const AccuracyPoint& answer = plan.answer;
  const auto is_answer = [&](const AccuracyPoint& point) {  // a curve has a point with its number of rays
    constexpr double alike = 0.01;
    return point.estimator == answer.estimator && std::abs(point.rays / answer.rays - 1) < alike &&
           std::abs(point.radius - answer.radius) <= alike * answer.radius;
  };
  std::vector<AccuracyPoint> all;
  for (const AccuracyPoint& point : plan.points)
    if (point.on_frontier && point.total.value < 1 && !is_answer(point)) all.push_back(point);
  std::ranges::sort(all, {}, &AccuracyPoint::seconds);
  std::vector<AccuracyPoint> best;  // of points that are equally fast, the most accurate one
  for (const AccuracyPoint& point : all)
    if (best.empty() || point.total.value < best.back().total.value) best.push_back(point);
  const auto distance = [&](const AccuracyPoint& point) { return std::abs(std::log(point.seconds / answer.seconds)); };
  while (best.size() > most) best.erase(distance(best.front()) > distance(best.back()) ? best.begin() : best.end() - 1);
  return best;
}

}  // namespace detp::validate
