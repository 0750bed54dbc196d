#include "run_until.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/stopped.hpp"

namespace detp::validate {
namespace {

constexpr std::uint64_t batches_of_stage = 32;
constexpr double most_growth = 7;
constexpr double least_growth = 0.1;
constexpr double safety = 1.05;        // of the rays of the next stage, so that one more look is rarely needed
constexpr double share_of_bias = 0.9;  // of the square error: a larger bias leaves too little for the noise
// Shares of the error that tests may make: of those after stages that were not planned to reach the target, and of those when a run that
// can go on is stopped.
constexpr double share_of_looks = 0.05;
constexpr double share_of_stops = 0.05;
constexpr double least_error = 1e-12;  // of a test: 1 - error must be below 1
constexpr double share_of_tests = 1 - share_of_looks - share_of_stops;

double squared(double x) { return x * x; }

class UntilRun {
 public:
  UntilRun(const NextBatch& next, std::vector<double> weights, const ErrorTarget& target, const UntilOptions& options)
      : next_(next), target_(target), options_(options), batches_(std::move(weights)) {
    check(target);
    if (target.bias_squared) bias_ = std::max(0.0, target.bias_squared->mean);
  }

  UntilResult run() && {
    require_positive("most rays", options_.most_rays);
    require_positive("most rays of a batch", static_cast<double>(options_.most_in_batch));
    if (options_.resume)
      go_on_from(*options_.resume);
    else
      begin({static_cast<double>(std::max<std::uint64_t>(options_.first_rays, 2 * batches_of_stage))});
    try {
      while (true) {
        const bool ended = !finish_stage();
        result_.noise = batches_.noise(target_.confidence);
        if (bias_ >= share_of_bias * squared(target_.error)) return finished(StopReason::bias);
        const bool last = stage_.is_last || ended;
        if (passes_test(last ? error_left() : error_allowed(stage_.is_test))) return finished(StopReason::target);
        if (last) return finished(StopReason::rays);
        begin(next_stage());
      }
    } catch (const sim::Stopped&) {
      const bool passes = passes_stop();
      if (options_.save) options_.save([this] { return state(); });
      return finished(passes ? StopReason::target : StopReason::time);
    }
  }

 private:
  struct Stage {
    double rays = 0;
    bool is_test = false;  ///< planned to reach the target
    bool is_last = false;
    std::uint64_t batches = 0;  ///< that it has
  };

  void begin(Stage stage) {
    const double left = options_.most_rays - static_cast<double>(result_.rays);
    stage.is_last = stage.rays >= left;
    stage.rays = std::min(stage.rays, left);
    stage_ = stage;
  }

  void go_on_from(const UntilState& state) {
    batches_.set_state(state.batches);
    result_.rays = state.rays;
    result_.tests = state.tests;
    result_.looks = state.looks;
    result_.stops = state.stops;
    result_.noise = batches_.noise(target_.confidence);
    stage_ = {state.stage_rays, state.stage_is_test, state.stage_is_last, state.stage_batches};
  }

  [[nodiscard]] UntilState state() const {
    return {batches_.state(), result_.rays,   result_.tests,  result_.looks, result_.stops,
            stage_.rays,      stage_.is_test, stage_.is_last, stage_.batches};
  }

  /// The error of the next test.
  [[nodiscard]] double error_allowed(bool planned) const {
    if (planned) return share_of_tests * error_of_test(target_.confidence, result_.tests + 1);
    return share_of_looks * (1 - target_.confidence) * std::exp2(-result_.looks - 1);
  }
  /// What tests and looks so far have left of 1 - confidence: Σ error_of_test is (1 - confidence)(1 - 3^-tests).
  [[nodiscard]] double error_left() const {
    return (1 - target_.confidence) *
           (share_of_tests * std::pow(3.0, -result_.tests) + share_of_looks * std::exp2(-result_.looks));
  }

  [[nodiscard]] double noise_allowed() const { return std::sqrt(std::max(0.0, squared(target_.error) - bias_)); }

  bool passes_test(double error) {
    ++(stage_.is_test ? result_.tests : result_.looks);
    return passes(error);
  }
  /// A run that can go on keeps what later tests may err with: it ends as one that was not stopped.
  bool passes_stop() {
    const double stops = share_of_stops * (1 - target_.confidence) * std::exp2(-result_.stops);
    ++result_.stops;
    return passes(options_.save ? stops / 2 : stops + error_left());
  }
  bool passes(double error) {
    result_.noise = batches_.noise(1 - std::max(error, least_error));
    return result_.noise.high <= noise_allowed();
  }

  /// False if there are no more rays.
  bool finish_stage() {
    const auto in_one = static_cast<double>(options_.most_in_batch);
    const double pairs = std::max(static_cast<double>(batches_of_stage) / 2, std::ceil(stage_.rays / (2 * in_one)));
    const auto each = static_cast<std::uint64_t>(std::max(1.0, std::ceil(stage_.rays / (2 * pairs))));
    while (static_cast<double>(stage_.batches) < 2 * pairs) {
      report(static_cast<double>(stage_.batches) / (2 * pairs));
      const std::optional<Batch> found = next_(each, static_cast<std::uint64_t>(2 * pairs) - stage_.batches - 1);
      if (!found) return false;
      batches_.add(found->irradiance, found->photons);
      result_.rays += found->rays;
      ++stage_.batches;
      if (options_.save) options_.save([this] { return state(); });
    }
    return true;
  }

  void report(double share) const {
    if (!options_.progress) return;
    const bool first = result_.noise.value == 0;
    const double known = first ? 0 : std::min(1.0, squared(noise_allowed() / result_.noise.high));
    const std::string what = first ? "first rays" : fmt::format("noise {:.2g} %", 100 * result_.noise.value);
    options_.progress({what, known + (1 - known) * share, 1});
  }

  [[nodiscard]] Stage next_stage() const {
    const auto rays = static_cast<double>(result_.rays);
    const double needed = batches_.photons_for(noise_allowed(), 1 - error_allowed(true)) / batches_.photons() * rays;
    const double more = std::max(safety * needed - rays, least_growth * rays);
    return {std::min(more, most_growth * rays), more <= most_growth * rays};
  }

  UntilResult finished(StopReason reason) {
    result_.reason = reason;
    result_.irradiance = batches_.irradiance();
    result_.photons = batches_.photons();
    if (result_.photons > 0 && std::ranges::all_of(result_.irradiance, [](double one) { return one == 0; }))
      result_.share_bound = std::min(1.0, -std::log1p(-target_.confidence) / result_.photons);
    return std::move(result_);
  }

  const NextBatch& next_;
  const ErrorTarget& target_;
  const UntilOptions& options_;
  PairedBatches batches_;
  UntilResult result_;
  Stage stage_;
  double bias_ = 0;  ///< bias², not below 0
};

}  // namespace

void check(const ErrorTarget& target) {
  require_ratio("target error", target.error);
  require_ratio("confidence", target.confidence);
}

NoiseInterval with_bias(const NoiseInterval& noise, const Estimate& bias_squared) {
  constexpr double two_sided = 1.96;
  const auto total = [&](double one, double shift) {
    return std::sqrt(squared(one) + std::max(0.0, bias_squared.mean + shift * bias_squared.standard_error));
  };
  return {total(noise.value, 0), total(noise.low, -two_sided), total(noise.high, two_sided)};
}

std::string_view name(StopReason reason) {
  switch (reason) {
    case StopReason::target:
      return "target";
    case StopReason::bias:
      return "bias";
    case StopReason::rays:
      return "rays";
    case StopReason::time:
      return "time";
  }
  throw std::logic_error("a reason without a name");
}

UntilResult run_until(const NextBatch& next, std::vector<double> weights, const ErrorTarget& target,
                      const UntilOptions& options) {
  return UntilRun(next, std::move(weights), target, options).run();
}

}  // namespace detp::validate
