#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "accuracy_plan.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"

namespace detp::validate {
namespace {

/// Whether an estimator is out of the question: far from the target, or from the fastest.
bool is_out(const AccuracyPoint& way, const AccuracyPlan& plan) {
  constexpr double far = 4;
  if (plan.target.kind == AccuracyTarget::Kind::seconds) return way.total.low > plan.answer.total.high;
  if (plan.reached && way.seconds > far * plan.answer.seconds) return true;
  return way.bias.low > plan.target.value && way.bias.value > plan.answer.bias.value;
}

/// The answer, or the rival that is faster by the prediction, left out by a bias that may yet be below the target, and least known.
const AccuracyPoint& least_known(const AccuracyPlan& plan, double wanted) {
  const AccuracyPoint* least = &plan.answer;
  if (plan.target.kind == AccuracyTarget::Kind::seconds) return *least;
  for (const AccuracyPoint& rival : plan.rivals) {
    const bool left_out = plan.target.kind == AccuracyTarget::Kind::total ? !reaches(rival, plan.target)
                                                                          : rival.bias.value > plan.target.value;
    const bool may_be_better =
        left_out && rival.bias.low < plan.target.value && rival.seconds * clearly_slower < plan.answer.seconds;
    if (may_be_better && rival.bias.half_width() > std::max(wanted, least->bias.half_width())) least = &rival;
  }
  return *least;
}

/// Settles all settings of estimators that are out, and of the others those that are not beside the setting in question.
void settle(AccuracyPilot& pilot, const AccuracyPlan& plan) {
  std::vector<AccuracyPoint> ways = plan.rivals;
  ways.push_back(plan.answer);
  for (EstimatorPilot& one : pilot.estimators) {
    const auto way = std::ranges::find(ways, one.estimator, &AccuracyPoint::estimator);
    const bool out = way == ways.end() || is_out(*way, plan);
    for (std::size_t i = 0; i < one.settings.size(); ++i) {
      const bool below = i + 1 < one.settings.size() && one.settings[i + 1].scale <= way->radius;
      const bool above = i > 0 && one.settings[i - 1].scale >= way->radius;
      one.settings[i].settled = out || (uses_radius(one.estimator) && (below || above));
    }
  }
}

/// Pilots of one question, within the price of its answer.
class Planner {
 public:
  Planner(sim::Scene& scene, const AccuracyTarget& target, const AccuracyPilotOptions& options, double most_rays)
      : target_(target),
        options_(options),
        most_rays_(most_rays),
        maker_(scene, options),
        predicted_(maker_.fixed_seconds()) {}

  PilotedPlan plan() && {
    try {
      make_pilots();
      rehearse();
    } catch (const sim::Stopped&) {
      if (found_.pilot.estimators.empty()) throw;
      found_.stopped = true;
    }
    found_.pilot.seconds = watch_.seconds();
    return std::move(found_);
  }

 private:
  [[nodiscard]] double price() const {
    return std::max(options_.least_price, options_.price * found_.plan.answer.seconds);
  }

  /// Seconds of the price that are kept for a rehearsal of the answer.
  [[nodiscard]] double reserved() const {
    const auto size = rehearsal_size((1 - share_of_pilots) * price());
    return size ? size->seconds : 0;
  }

  [[nodiscard]] std::optional<PilotMaker::RehearsalSize> rehearsal_size(double seconds) const {
    constexpr double most_share = 0.25;  // of the answer's rays
    const AccuracyPoint& best = found_.plan.answer;
    return maker_.rehearsal_size(found_.pilot, best.setting(), most_share * best.rays, seconds);
  }

  /// Until the bias is known well enough, or would cost too much.
  void make_pilots() {
    const PilotSize first = maker_.first_size();
    predicted_ += maker_.predicted_seconds(first, nullptr);
    escalate(maker_, found_.pilot, first, [this](const PilotSize& made) {
      found_.plan = plan_accuracy(found_.pilot, target_, most_rays_);
      const std::optional<PilotSize> next = next_size(made);
      if (next) predicted_ += maker_.predicted_seconds(*next, &found_.pilot);
      return next;
    });
  }

  /// After a pilot: as much as the price allows of what decides; nothing if the bias is known, or if that is too little.
  [[nodiscard]] std::optional<PilotSize> next_size(const PilotSize& made) {
    constexpr double enough = 0.2;           // of the target, for half the width of the bias's interval
    constexpr double deciding_share = 0.25;  // of the variance of bias²
    constexpr double most_pilot_rays = 4e7;
    const AccuracyPoint& best = found_.plan.answer;
    const double wanted = enough * (target_.kind == AccuracyTarget::Kind::seconds ? best.total.value : target_.value);
    const AccuracyPoint& open = least_known(found_.plan, wanted);
    if (open.bias.half_width() <= wanted || made.rays > most_pilot_rays) return std::nullopt;
    const double by_reference = found_.pilot.of(open.estimator).by_reference;
    const bool by_paths = by_reference > deciding_share && options_.reference == nullptr;
    const bool by_rays = by_reference < 1 - deciding_share;
    if (!by_rays && !by_paths) return std::nullopt;
    settle(found_.pilot, found_.plan);
    for (double more = 4; more >= 1.4; more /= std::sqrt(2)) {
      PilotSize next = made;
      if (by_rays) next.rays *= more;
      if (by_paths) next.paths = static_cast<std::uint64_t>(more * static_cast<double>(made.paths));
      if (predicted_ + maker_.predicted_seconds(next, &found_.pilot) <= price() - reserved()) return next;
    }
    return std::nullopt;
  }

  /// Until the noise of the answer is that of a rehearsal, or the price is spent: another way may be better then.
  void rehearse() {
    constexpr double near = 1.3;  // scales
    for (;;) {
      const AccuracyPoint& best = found_.plan.answer;
      const double rehearsed = found_.pilot.of(best.estimator).rehearsed;
      if (rehearsed > 0 && best.scale() < near * rehearsed && rehearsed < near * best.scale()) return;
      const auto size = rehearsal_size(price() - predicted_);
      if (!size) return;
      predicted_ += size->seconds;
      maker_.rehearse(found_.pilot, best.setting(), *size, best.rays);
      found_.plan = plan_accuracy(found_.pilot, target_, most_rays_);
    }
  }

  AccuracyTarget target_;
  AccuracyPilotOptions options_;
  double most_rays_;
  sim::Stopwatch watch_;
  PilotMaker maker_;
  PilotedPlan found_;
  double predicted_;  // seconds of all pilots, with what they need
};

}  // namespace

PilotedPlan plan_accuracy(sim::Scene& scene, const AccuracyTarget& target, AccuracyPilotOptions options,
                          double most_rays) {
  check(target, most_rays);
  return Planner(scene, target, options, most_rays).plan();
}

}  // namespace detp::validate
