#include "accuracy_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"

namespace detp::validate {
namespace {

constexpr int scales_tried = 49;
constexpr double interval = 1.96;
constexpr double share_for_bias = 0.98;  // a total target leaves at least 2 % of its square to noise

double square_of(double x) { return x * x; }

double root(double square) { return std::sqrt(std::max(0.0, square)); }

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
    rays = std::clamp(std::ceil(rays), 1.0, most_rays_);
    const Estimate bias = own_.bias_squared(scale);
    const double noise_squared = own_.noise_squared(scale, rays);
    const bool radius = uses_radius(own_.estimator);
    AccuracyPoint point{.estimator = own_.estimator, .rays = rays, .photons = rays * pilot_.photons_per_ray};
    if (radius) point.radius = scale;
    if (own_.estimator == sim::Estimator::nearest)
      point.nearest = static_cast<int>(std::clamp(std::round(scale * rays), 3.0, 1e9));
    point.noise = std::sqrt(noise_squared);
    const double wide = std::exp(0.5 * spread_ * own_.noise_squared_error(scale));
    point.noise_low = point.noise / wide;
    point.noise_high = point.noise * wide;
    point.bias = root(bias.mean);
    point.bias_high = root(bias.mean + interval * bias.standard_error);
    const auto bias_squared = [&](double shift) { return std::max(0.0, bias.mean + shift * bias.standard_error); };
    const double square = noise_squared + bias_squared(0);
    const double down =
        std::hypot(noise_squared - square_of(point.noise_low), bias_squared(0) - bias_squared(-interval));
    const double up = std::hypot(square_of(point.noise_high) - noise_squared, bias_squared(interval) - bias_squared(0));
    point.total = root(square);
    point.total_low = root(square - down);
    point.total_high = root(square + up);
    point.trace_seconds = pilot_.trace_seconds(rays);
    point.seconds = point.trace_seconds + own_.fixed_seconds(scale) + own_.seconds_per_ray(scale) * rays;
    // The noise's share of total² is that of d ln total / d ln rays = -1/2 noise²/total².
    const double seconds_slope = (pilot_.trace_seconds_per_ray + own_.seconds_per_ray(scale)) * rays / point.seconds;
    const auto slope = [&](double noise, double total) {
      return -0.5 * std::min(1.0, square_of(noise / total)) / seconds_slope;
    };
    point.slope = slope(point.noise, point.total);
    point.slope_low = slope(point.noise, std::max(point.noise, point.total_low));
    point.slope_high = slope(point.noise, point.total_high);
    return point;
  }

  /// Nothing if no setting and number of rays reach the target.
  [[nodiscard]] std::optional<AccuracyPoint> reach(const AccuracyTarget& target) const {
    switch (target.kind) {
      case AccuracyTarget::Kind::noise:
        return reach_noise(target.value);
      case AccuracyTarget::Kind::total:
        return reach_total(target.value);
      case AccuracyTarget::Kind::seconds:
        break;
    }
    return most_accurate([&](double scale) { return rays_in(scale, target.value); });
  }

  [[nodiscard]] AccuracyPoint best_with(double rays) const {
    return *most_accurate([&](double) { return rays; });
  }

  [[nodiscard]] double least_bias() const { return root(own_.bias_squared(least_biased()).mean); }

  /// The setting of the least bias, with so many rays that noise adds a twentieth to the square.
  [[nodiscard]] AccuracyPoint nearest_to_floor() const {
    constexpr double share_of_noise = 0.05;
    const double scale = least_biased();
    const double bias = own_.bias_squared(scale).mean;
    return at(scale, bias > 0 ? own_.noise_squared(scale, 1) / (share_of_noise * bias) : most_rays_);
  }

 private:
  [[nodiscard]] double least_biased() const {
    return *std::ranges::min_element(scales_, {}, [&](double scale) { return own_.bias_squared(scale).mean; });
  }

  /// Rays that the time allows.
  [[nodiscard]] double rays_in(double scale, double seconds) const {
    const double per_ray = pilot_.trace_seconds_per_ray + own_.seconds_per_ray(scale);
    return std::max(1.0, (seconds - pilot_.trace_fixed_seconds - own_.fixed_seconds(scale)) / per_ray);
  }

  [[nodiscard]] std::optional<AccuracyPoint> reach_noise(double noise) const {
    std::optional<AccuracyPoint> best;
    for (const double scale : scales_) {
      const double rays = own_.noise_squared(scale, 1) / (noise * noise);
      if (rays > most_rays_) continue;
      const AccuracyPoint point = at(scale, rays);
      const bool below = point.bias <= noise;
      const bool best_below = best && best->bias <= noise;
      // the largest setting with a bias below the noise; else the one with the least bias
      if (!best || (below && (!best_below || point.seconds <= best->seconds)) ||
          (!below && !best_below && point.bias < best->bias))
        best = point;
    }
    return best;
  }

  [[nodiscard]] std::optional<AccuracyPoint> reach_total(double total) const {
    std::optional<AccuracyPoint> best;
    for (const double scale : scales_) {
      const double bias = std::max(0.0, own_.bias_squared(scale).mean);
      if (bias > share_for_bias * total * total) continue;
      const double rays = own_.noise_squared(scale, 1) / (total * total - bias);
      if (rays > most_rays_) continue;
      const AccuracyPoint point = at(scale, rays);
      if (!best || point.seconds < best->seconds) best = point;
    }
    return best;
  }

  template <class Rays>
  [[nodiscard]] std::optional<AccuracyPoint> most_accurate(const Rays& rays) const {
    std::optional<AccuracyPoint> best;
    for (const double scale : scales_) {
      const AccuracyPoint point = at(scale, rays(scale));
      if (!best || point.total < best->total) best = point;
    }
    return best;
  }

  const AccuracyPilot& pilot_;
  const EstimatorPilot& own_;
  double most_rays_;
  double spread_;  ///< half width of an interval of 95 %, in standard errors
  std::vector<double> scales_;
};

void mark_frontier(std::vector<AccuracyPoint>& points) {
  for (AccuracyPoint& one : points)
    one.on_frontier = std::ranges::none_of(points, [&](const AccuracyPoint& other) {
      return other.seconds <= one.seconds && other.total_high < one.total_low;
    });
}

}  // namespace

void check(const AccuracyTarget& target, double most_rays) {
  if (target.kind == AccuracyTarget::Kind::seconds)
    require_positive("time budget", target.value);
  else
    require_ratio("target error", target.value);
  require_count("number of rays", std::floor(most_rays), 1, 1e18);
}

AccuracyPlan plan_accuracy(const AccuracyPilot& pilot, const AccuracyTarget& target, double most_rays) {
  check(target, most_rays);
  AccuracyPlan plan;
  plan.target = target;
  std::vector<AccuracyPoint> reached;
  std::vector<AccuracyPoint> nearest;  // to the target, of those that do not reach it
  plan.floor = std::numeric_limits<double>::infinity();
  for (const EstimatorPilot& own : pilot.estimators) {
    const Ways ways(pilot, own, most_rays);
    plan.floor = std::min(plan.floor, ways.least_bias());
    if (const auto point = ways.reach(target))
      reached.push_back(*point);
    else
      nearest.push_back(ways.nearest_to_floor());
  }
  // A noise target that one estimator meets with a bias below the noise is not answered by one with more bias.
  const auto worse = [&](const AccuracyPoint& one) {
    return target.kind == AccuracyTarget::Kind::noise && one.bias > target.value;
  };
  std::ranges::sort(reached, [&](const AccuracyPoint& a, const AccuracyPoint& b) {
    if (worse(a) != worse(b)) return worse(b);
    if (worse(a)) return a.total < b.total;
    return target.kind == AccuracyTarget::Kind::seconds ? a.total < b.total : a.seconds < b.seconds;
  });
  std::ranges::sort(nearest, {}, &AccuracyPoint::total);
  plan.reached = !reached.empty();
  std::vector<AccuracyPoint>& best = plan.reached ? reached : nearest;
  plan.answer = best.front();
  plan.rivals.assign(best.begin() + 1, best.end());
  if (plan.reached) plan.rivals.insert(plan.rivals.end(), nearest.begin(), nearest.end());
  for (const EstimatorPilot& own : pilot.estimators) {
    const Ways ways(pilot, own, most_rays);
    for (int step = -3; step <= 3; ++step) {
      const double rays = plan.answer.rays * std::pow(4.0, step);
      if (rays >= 1000 && rays <= most_rays) plan.points.push_back(ways.best_with(rays));
    }
  }
  mark_frontier(plan.points);
  return plan;
}

namespace {

/// Reports with the time that is left of the expected seconds.
sim::ReportPhase with_time_left(const sim::ReportPhase& report, double expected) {
  if (!report) return {};
  return [report, expected, watch = sim::Stopwatch{}](const sim::Phase& phase) {
    const double done = std::min(1.0, watch.seconds() / expected);
    report({phase.what, done, 1, 0, (1 - done) * expected});
  };
}

}  // namespace

PilotedPlan plan_accuracy(sim::Scene& scene, const AccuracyTarget& target, AccuracyPilotOptions options,
                          double most_rays) {
  constexpr double least_price = 1.5;        // seconds that they may always take
  constexpr double enough_resolution = 0.5;  // of the target's square, for the standard error of bias²
  constexpr double most_pilot_rays = 1e7;
  check(target, most_rays);
  const sim::Stopwatch watch;
  if (!(options.rays > 0)) options.rays = usual_pilot_rays;
  PilotedPlan found;
  const sim::ReportPhase report = options.progress;
  for (bool first = true;; first = false, options.rays *= 4) {
    if (!first) options.progress = with_time_left(report, 4 * found.pilot.seconds);
    try {
      found.pilot = make_accuracy_pilot(scene, options);
    } catch (const sim::Stopped&) {
      if (first) throw;
      found.stopped = true;
      return found;
    }
    found.plan = plan_accuracy(found.pilot, target, most_rays);
    const AccuracyPoint& best = found.plan.answer;
    const double bias_error = (best.bias_high * best.bias_high - best.bias * best.bias) / interval;
    const double square = std::pow(target.kind == AccuracyTarget::Kind::seconds ? best.total : target.value, 2);
    const double most_seconds = std::max(least_price, options.price * best.seconds);
    if (bias_error <= enough_resolution * square || watch.seconds() + 4 * found.pilot.seconds > most_seconds ||
        options.rays > most_pilot_rays)
      return found;
  }
}

}  // namespace detp::validate
