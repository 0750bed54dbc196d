#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "batch_errors.hpp"
#include "detp/sim/geometry/paths.hpp"
#include "detp/sim/photons/light_ledger.hpp"
#include "detp/sim/search/outcome.hpp"
#include "detp/validate/accuracy/judged_samples.hpp"
#include "detp/validate/choice/plan.hpp"
#include "run_until.hpp"

/// Searches batches of rays until the irradiance is known well enough.
namespace detp::validate {

/// The numbers 0 … count - 1, each once, in an order that the seed decides. Takes no memory.
class RandomOrder {
 public:
  RandomOrder(std::uint64_t count, std::uint64_t seed);

  /// `place` < count.
  [[nodiscard]] std::uint64_t operator[](std::uint64_t place) const;

 private:
  /// A permutation of the numbers of 2 half_bits_ bits.
  [[nodiscard]] std::uint64_t permuted(std::uint64_t number) const;

  std::uint64_t count_;
  std::uint64_t seed_;
  int half_bits_ = 1;
};

/// Rays of whole photons. They must stay until the next batch is made.
struct RayBatch {
  sim::PathRays rays;
  double photons = 0;           ///< emitted, with those that gave no ray; without photon numbers: the number of rays
  double scale = 1;             ///< irradiance of these rays times `scale`: that as if they were all photons
  sim::LightLedger light = {};  ///< of photons that were traced for it
};

/// Throws std::invalid_argument unless photons and scale are finite and > 0, and the rays' numbered photons at most `photons`.
void check(const RayBatch& batch);

/// Makes a batch of about so many rays, to the end of the last photon; nothing if there are no more. May throw sim::Stopped.
using NextRays = std::function<std::optional<RayBatch>(std::uint64_t rays)>;

/// A batch whose rays have been searched.
struct FoundBatch {
  Batch batch;              ///< its irradiance is that in question
  sim::Outcome outcome;     ///< in all bands, as if the batch were all photons
  double make_seconds = 0;  ///< for making the rays
  sim::LightLedger light = {};
};

/// As NextBatch.
using FindBatch = std::function<std::optional<FoundBatch>(std::uint64_t rays, std::uint64_t following)>;

/// The irradiance whose noise is in question: of a band; none: the sum of all.
using BandInQuestion = std::optional<std::size_t>;

/// Throws std::invalid_argument for a band that the outcome does not have.
[[nodiscard]] std::vector<double> irradiance_of(const sim::Outcome& found, BandInQuestion band);

/// The irradiance of rays that a search has found.
[[nodiscard]] FoundBatch found_batch(const RayBatch& made, const sim::Outcome& found, double make_seconds,
                                     BandInQuestion band = {});

/// What batches bring in one band.
struct BandBatches {
  BatchMean irradiance;
  BatchErrors errors = {};  ///< empty unless the searches have standard errors
};

struct ExecutedUntil {
  UntilResult result;                   ///< its irradiance is that in question
  sim::Outcome outcome;                 ///< hits, counts and seconds of all batches; no irradiance
  std::vector<BandBatches> bands = {};  ///< empty before the first batch
  double make_seconds = 0;              ///< for making the rays
  sim::LightLedger light = {};          ///< of all batches

  /// Irradiance, errors and bounds in all bands, into `outcome`. `scale`: of all of them.
  void fill_outcome(double scale = 1);
};

/// Called after each batch, and when a stop request ends the run, with what a run needs to go on from there: the state, which is copied when asked for, and the outcome so far.
using SaveExecuted = std::function<void(const std::function<UntilState()>& state, const ExecutedUntil& so_far)>;

/// run_until for rays. A run that goes on from options.resume begins with the outcome of `before`; `save` takes the place of options.save.
/// `weights` of the discs by area, with sum 1. Throws as run_until and the search.
[[nodiscard]] ExecutedUntil execute_until(const FindBatch& find, std::vector<double> weights, const ErrorTarget& target,
                                          const UntilOptions& options = {}, ExecutedUntil before = {},
                                          const SaveExecuted& save = {});

/// The same with a plan's technique and index, on its threads.
[[nodiscard]] ExecutedUntil execute_until(const Plan& plan, const NextRays& next, std::vector<double> weights,
                                          const ErrorTarget& target, const UntilOptions& options = {},
                                          BandInQuestion band = {});

/// Gives rays in memory batch by batch: in their order, not copied, or the photons in random order.
class StoredBatches {
 public:
  /// `photons`: of all rays, with those that gave none. `seed`: of the random order; none: that of the rays.
  StoredBatches(const sim::PathRays& rays, std::uint64_t photons, std::optional<std::uint64_t> seed = {});

  /// The batch, if it is in random order, has its own numbers of photons, and stays until the next one. Nothing at the end.
  [[nodiscard]] std::optional<RayBatch> next(std::uint64_t rays);

  [[nodiscard]] bool at_end() const { return drawn_ == photons_ || given_ == all_.rays.size(); }
  /// Goes on after the batches that had so many photons and rays; if there are fewer, at the end.
  void skip(std::uint64_t photons, std::uint64_t rays) {
    drawn_ = std::min(photons, photons_);
    given_ = static_cast<std::size_t>(std::min<std::uint64_t>(rays, all_.rays.size()));
  }

 private:
  /// Number of the ray's photon; at the end, the number of all photons.
  [[nodiscard]] std::uint64_t photon(std::size_t ray) const;
  [[nodiscard]] RayBatch in_order(std::uint64_t rays);
  [[nodiscard]] RayBatch drawn(std::uint64_t rays);

  sim::PathRays all_;
  std::uint64_t photons_;
  std::optional<RandomOrder> order_;
  sim::Paths batch_;
  std::uint64_t drawn_ = 0;  ///< photons, of all that were given
  std::size_t given_ = 0;    ///< rays
};

}  // namespace detp::validate
