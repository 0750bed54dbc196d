#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "accuracy_pilot.hpp"

/// What accuracy costs: how many rays and which setting reach an error, and what error a time buys.
namespace detp::validate {

struct AccuracyTarget {
  enum class Kind { noise, total, seconds };
  Kind kind = Kind::noise;
  double value = 0.05;  ///< relative error, or seconds
};

/// "noise", "error" or "seconds".
[[nodiscard]] std::string_view name(AccuracyTarget::Kind kind);

/// One way to estimate, with its errors over the samples by area, relative to the root mean square irradiance, and their intervals of 95 %.
struct AccuracyPoint {
  sim::Estimator estimator = sim::Estimator::disc;
  double rays = 0;  ///< pieces of photon paths; of gather, backward paths of each sample
  double photons = 0;
  double radius = 0;        ///< scene units; 0: not used
  int nearest = 0;          ///< k; 0: not used
  RootInterval noise = {};  ///< of one run: its error without the bias, over the samples, lies within
  bool noise_weak = false;  ///< too few photons bring most of it (enough_rare_photons): its interval may not hold
  RootInterval bias = {};   ///< from 0: there may be none
  Estimate mean_bias = {};  ///< signed: light gained or lost, relative to the mean irradiance
  /// √(noise² + the mean of bias², normal with its error and cut off below 0): a bias that is hardly known counts, so this may be above
  /// √(noise² + bias²). Of one run: both intervals, whose errors are independent.
  RootInterval total = {};
  double trace_seconds = 0;
  double seconds = 0;  ///< predicted, tracing included
  /// The total error changes as this power of the seconds, at this setting: d ln total / d ln seconds; its interval is that of the total
  RootInterval slope = {};
  bool on_frontier = false;  ///< no other point is more accurate and faster, their intervals apart

  [[nodiscard]] AccuracySetting setting() const { return {estimator, radius, nearest}; }
  /// It has backward paths instead of photons.
  [[nodiscard]] bool gathers() const { return estimator == sim::Estimator::gather; }
  /// As SettingPilot::scale.
  [[nodiscard]] double scale() const { return radius > 0 ? radius : nearest > 0 ? nearest / rays : 1; }
};

struct AccuracyPlan {
  AccuracyTarget target;
  /// The fastest way to the target; if none reaches it, the most accurate one.
  AccuracyPoint answer;
  bool reached = true;
  double floor = 0;                   ///< least bias of any estimator
  std::vector<AccuracyPoint> points;  ///< for each estimator from few to many rays, each with its best setting
  std::vector<AccuracyPoint> rivals;  ///< the best way of each other estimator, the fastest first
  std::vector<sim::Estimator> ties;   ///< of them that predicted seconds do not tell from the answer
  /// If gather is left out: the bound (95 %) of the light that it misses, relative to B, which is above a tenth of the target.
  std::optional<double> gather_misses = {};
};

/// Throws std::invalid_argument unless an error is in (0, 1), seconds are > 0, and there may be from 1 to 1e18 rays.
void check(const AccuracyTarget& target, double most_rays);

/// Ways whose predicted seconds differ by less than this factor are about as fast.
inline constexpr double clearly_slower = 1.3;

/// Whether the point has the target's error, but for rounding; of a time, always.
[[nodiscard]] bool reaches(const AccuracyPoint& point, const AccuracyTarget& target);

/// From a pilot, by closed forms: noise² falls as 1/rays, bias does not change, seconds grow in proportion. gather is left out if the
/// light that it misses may be above a tenth of the target.
///
/// target noise: of each estimator the largest setting whose bias is below the noise (if there is none, that of the least bias); among
/// those the fastest, but none that another estimator beats in noise, total error and seconds. Of ways whose predicted seconds differ by less
/// than 1.3 times, the one with the least total error. target total: the fastest setting with noise² + bias² = target². target seconds: the
/// setting with the least total error in that time. At most `most_rays` rays. Throws std::invalid_argument for a target or a number of rays
/// out of range.
[[nodiscard]] AccuracyPlan plan_accuracy(const AccuracyPilot& pilot, const AccuracyTarget& target,
                                         double most_rays = 1e9);

/// Of the points on the frontier, at most so many around the answer and without it: each more accurate than all that are faster. Seconds rise.
[[nodiscard]] std::vector<AccuracyPoint> points_around_answer(const AccuracyPlan& plan, std::size_t most);

struct PilotedPlan {
  AccuracyPilot pilot = {};
  AccuracyPlan plan = {};
  bool stopped = false;  ///< by a stop request: the pilot before the last one answers
};

/// The same with pilots in the scene, until the half width of the bias's interval is at most a fifth of the target (of a time: of the total
/// error). The next pilot has up to four times the rays, or backward paths, or both, as one or both decide. Then the answer is rehearsed
/// (PilotMaker::rehearse), and so is another one that is better with the noise found. Nothing is made that would exceed the price with all
/// before: options.price times the answer's seconds, at least options.least_price, both as predicted. So the plan does not depend on the
/// clock. Throws as PilotMaker; sim::Stopped if there was no pilot yet.
[[nodiscard]] PilotedPlan plan_accuracy(sim::Scene& scene, const AccuracyTarget& target, AccuracyPilotOptions options,
                                        double most_rays = 1e9);

}  // namespace detp::validate
