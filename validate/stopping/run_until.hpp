#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "paired_batches.hpp"

/// Estimates an irradiance until its error is small enough.
namespace detp::validate {

/// The irradiance of whole photons, which are independent of those of all other batches.
struct Batch {
  std::vector<double> irradiance;  ///< of each disc, as if the batch were all photons
  double photons = 0;
  std::uint64_t rays = 0;
};

/// Makes the next batch, of about so many rays; nothing if there are no more. So many further ones of the same size will follow. May throw
/// sim::Stopped.
using NextBatch = std::function<std::optional<Batch>(std::uint64_t rays, std::uint64_t following)>;

/// Errors are root mean squares over the discs by area, relative to the root mean square irradiance.
struct ErrorTarget {
  double error = 0.05;
  double confidence = 0.95;  ///< that the error of this run is smaller
  /// bias² of the estimator and its standard error. If it is given, `error` is that of noise and bias together; else the noise.
  std::optional<Estimate> bias_squared = {};
};

/// Throws std::invalid_argument unless error and confidence are in (0, 1).
void check(const ErrorTarget& target);

enum class StopReason {
  target,  ///< the error is reached
  bias,    ///< the bias alone is as large: more rays do not help
  rays,    ///< the limit, or there are no more
  time     ///< a stop was requested: by a time limit or by the user
};

[[nodiscard]] std::string_view name(StopReason reason);

/// A run between two batches, from which it can go on.
struct UntilState {
  PairedBatches::State batches;
  std::uint64_t rays = 0;
  int tests = 0;
  int looks = 0;
  int stops = 0;
  double stage_rays = 0;            ///< of the stage under way
  bool stage_is_test = false;       ///< it is planned to reach the target
  bool stage_is_last = false;       ///< there may be no more rays after it
  std::uint64_t stage_batches = 0;  ///< that it has already

  /// Of all stages.
  [[nodiscard]] std::uint64_t batch_count() const {
    return 2 * batches.pairs.size() + (batches.pending_photons > 0 ? 1 : 0);
  }
};

struct UntilOptions {
  double most_rays = 1e9;
  std::uint64_t first_rays = 1 << 16;  ///< of the first stage
  std::uint64_t most_in_batch = 1 << 22;
  sim::ReportPhase progress = {};
  /// Goes on from there. `next` then gives the batches after it; the result is that of a run in one go.
  std::optional<UntilState> resume = {};
  /// Called after each batch, and when a stop request ends the run. `state` copies eleven numbers for a disc.
  std::function<void(const std::function<UntilState()>& state)> save = {};
};

struct UntilResult {
  std::vector<double> irradiance;  ///< mean of the batches by their photons
  NoiseInterval noise;             ///< of the last test: at least at the target's confidence, each end alone
  double photons = 0;
  std::uint64_t rays = 0;
  int tests = 0;  ///< after stages that were planned to reach the target
  int looks = 0;  ///< after other stages
  int stops = 0;  ///< on stop requests
  StopReason reason = StopReason::target;
  /// If no photon has met any disc: with the target's confidence the share of photons that meet one is smaller.
  std::optional<double> share_bound = {};
};

/// Of noise and bias together; the ends have the bias's interval of 95 %.
[[nodiscard]] NoiseInterval with_bias(const NoiseInterval& noise, const Estimate& bias_squared);

/// Adds batches in stages, each of 32 batches or, if they would be too large, more. Each stage has as many rays as will reach the target
/// by what the stages before know, but at most seven times and at least a tenth of the rays so far. After each stage the run
/// may end. Test t after a stage that was planned to reach the target may err with 0.9 (1 - confidence) 2/3ᵗ, look l after another one with
/// 0.05 (1 - confidence)/2ˡ, the one at the end of the rays with what these have left, and stop request s of a run that can go on
/// (`save`) with 0.05 (1 - confidence)/2ˢ, of another one with all that is left: all together with 1 - confidence.
/// The result's interval is that of the last test.
///
/// Asymptotic, as PairedBatches. If no photon met a disc among n: the bound -ln(1 - confidence)/n of their share.
/// Throws as check(ErrorTarget), std::invalid_argument unless most_rays > 0 and finite, for a batch whose numbers are not, and if the state is of other discs, and what `next` throws but sim::Stopped: then the result has what is known so far.
[[nodiscard]] UntilResult run_until(const NextBatch& next, std::vector<double> weights, const ErrorTarget& target,
                                    const UntilOptions& options = {});

}  // namespace detp::validate
