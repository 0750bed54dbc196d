#include "execute_until.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <span>
#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::validate {
namespace {

/// A part of an array that may be empty.
template <class T>
std::span<const T> part(std::span<const T> all, std::size_t first, std::size_t count) {
  return all.empty() ? all : all.subspan(first, count);
}

void scale_by(double scale, sim::Outcome& outcome) {
  for (std::size_t band = 0; band < outcome.bands(); ++band)
    for (auto* values :
         {&outcome.band(band).irradiance, &outcome.band(band).standard_error, &outcome.band(band).upper_bound})
      for (double& value : *values) value *= scale;
}

}  // namespace

void check(const RayBatch& batch) {
  require_positive("number of photons of a batch", batch.photons);
  require_positive("scale of a batch", batch.scale);
  const std::span<const std::uint64_t> numbers = batch.rays.photons;
  std::size_t photons = numbers.empty() ? 0 : 1;
  for (std::size_t i = 1; i < numbers.size(); ++i) photons += numbers[i] != numbers[i - 1] ? 1 : 0;
  if (static_cast<double>(photons) > batch.photons)
    throw std::invalid_argument(
        fmt::format("a batch has rays of {} photons, more than its {:g} photons", photons, batch.photons));
}

std::vector<double> irradiance_of(const sim::Outcome& found, BandInQuestion band) {
  if (band && *band >= found.bands())
    throw std::invalid_argument(fmt::format("band {} of {} is in question", *band + 1, found.bands()));
  if (band) return found.band(*band).irradiance;
  std::vector<double> sum = found.irradiance;
  for (const sim::BandResults& further : found.further)
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += further.irradiance[i];
  return sum;
}

FoundBatch found_batch(const RayBatch& made, const sim::Outcome& found, double make_seconds, BandInQuestion band) {
  if (found.stopped) throw sim::Stopped("stopped during a batch");
  FoundBatch batch{{{}, made.photons, made.rays.rays.size()}, found, make_seconds, made.light};
  scale_by(made.scale, batch.outcome);
  batch.batch.irradiance = irradiance_of(batch.outcome, band);
  return batch;
}

void ExecutedUntil::fill_outcome(double scale) {
  outcome.further.resize(bands.empty() ? 0 : bands.size() - 1);
  for (std::size_t band = 0; band < bands.size(); ++band) {
    const BandBatches& batches = bands[band];
    sim::BandResults& results = outcome.band(band);
    results.irradiance = batches.irradiance.irradiance();
    for (const sim::PowerError& error : batches.errors.of(results.irradiance, batches.irradiance.photons)) {
      results.standard_error.push_back(error.standard_error);
      results.upper_bound.push_back(error.upper_bound);
    }
  }
  scale_by(scale, outcome);
}

ExecutedUntil execute_until(const FindBatch& find, std::vector<double> weights, const ErrorTarget& target,
                            const UntilOptions& options, ExecutedUntil before, const SaveExecuted& save) {
  ExecutedUntil all = std::move(before);
  UntilOptions saving = options;
  if (save) saving.save = [&](const std::function<UntilState()>& state) { save(state, all); };
  const NextBatch next_batch = [&](std::uint64_t rays, std::uint64_t following) -> std::optional<Batch> {
    std::optional<FoundBatch> found = find(rays, following);
    if (!found) return std::nullopt;
    all.make_seconds += found->make_seconds;
    all.light += found->light;
    const sim::Outcome& outcome = found->outcome;
    all.bands.resize(std::max(all.bands.size(), outcome.bands()));
    if (all.bands.size() != outcome.bands())
      throw std::invalid_argument(
          fmt::format("a batch has powers in {} bands, others in {}", outcome.bands(), all.bands.size()));
    for (std::size_t band = 0; band < outcome.bands(); ++band) {
      const sim::BandResults& results = outcome.band(band);
      all.bands[band].irradiance.add(results.irradiance, found->batch.photons);
      if (!results.standard_error.empty()) all.bands[band].errors.add(results, outcome.hits, found->batch.photons);
    }
    add_block(outcome, all.outcome);
    all.outcome.hits.resize(outcome.hits.size());
    for (std::size_t disc = 0; disc < outcome.hits.size(); ++disc) all.outcome.hits[disc] += outcome.hits[disc];
    return std::move(found->batch);
  };
  all.result = run_until(next_batch, std::move(weights), target, saving);
  return all;
}

ExecutedUntil execute_until(const Plan& plan, const NextRays& next, std::vector<double> weights,
                            const ErrorTarget& target, const UntilOptions& options, BandInQuestion band) {
  plan.build();
  sim::SearchScratch scratch;
  const FindBatch find = [&](std::uint64_t rays, std::uint64_t) -> std::optional<FoundBatch> {
    const sim::Stopwatch watch;
    const std::optional<RayBatch> made = next(rays);
    const double make_seconds = watch.seconds();
    if (!made) return std::nullopt;
    check(*made);
    return found_batch(*made, plan.searcher().search(made->rays, scratch, {.threads = plan.threads()}), make_seconds,
                       band);
  };
  return execute_until(find, std::move(weights), target, options);
}

std::uint64_t StoredBatches::photon(std::size_t ray) const {
  if (ray == all_.rays.size()) return photons_;
  return all_.photons.empty() ? ray : all_.photons[ray];
}

StoredBatches::StoredBatches(const sim::PathRays& rays, std::uint64_t photons, std::optional<std::uint64_t> seed)
    : all_(rays), photons_(photons) {
  if (seed) order_.emplace(photons, *seed);
}

std::optional<RayBatch> StoredBatches::next(std::uint64_t rays) {
  if (at_end()) return std::nullopt;
  RayBatch batch = order_ ? drawn(rays) : in_order(rays);
  batch.scale = static_cast<double>(photons_) / batch.photons;
  given_ += batch.rays.rays.size();
  drawn_ += static_cast<std::uint64_t>(batch.photons);
  return batch;
}

RayBatch StoredBatches::in_order(std::uint64_t wanted) {
  const std::size_t size = all_.rays.size();
  const std::size_t first = given_;
  std::size_t end = first + static_cast<std::size_t>(std::min<std::uint64_t>(wanted, size - first));
  while (end < size && photon(end) == photon(end - 1)) ++end;
  const std::size_t count = end - first;
  sim::PathRays rays(all_.rays.subspan(first, count), part(all_.photons, first, count),
                     part(all_.landings, first, count), photon(end), part(all_.triangles, first, count));
  const std::size_t further = all_.further.bands;
  rays.further = {part(all_.further.values, first * further, count * further), further};
  return {rays, static_cast<double>(photon(end) - (first == 0 ? 0 : photon(first)))};
}

RayBatch StoredBatches::drawn(std::uint64_t rays) {
  batch_ = {};
  std::uint64_t& photons = batch_.photon_count;
  while (batch_.rays.size() < rays && drawn_ + photons < photons_) {
    const std::uint64_t drawn = (*order_)[drawn_ + photons];
    std::size_t ray = drawn;
    if (!all_.photons.empty())
      ray = static_cast<std::size_t>(std::ranges::lower_bound(all_.photons, drawn) - all_.photons.begin());
    for (; ray < all_.rays.size() && photon(ray) == drawn; ++ray) {
      batch_.add(all_, ray, photons);
    }
    ++photons;
  }
  return {batch_, static_cast<double>(photons)};
}

namespace {

constexpr std::uint64_t rounds =
    4;  // of a Feistel network: with four the order is as good as random (Luby and Rackoff 1988)

}  // namespace

RandomOrder::RandomOrder(std::uint64_t count, std::uint64_t seed)
    : count_(count), seed_(seed), half_bits_(static_cast<int>(std::bit_width(count) + 1) / 2) {}

std::uint64_t RandomOrder::operator[](std::uint64_t place) const {
  // Numbers beyond the count are passed over: at most three in four.
  do place = permuted(place);
  while (place >= count_);
  return place;
}

std::uint64_t RandomOrder::permuted(std::uint64_t number) const {
  const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
  std::uint64_t left = number >> half_bits_;
  std::uint64_t right = number & mask;
  for (std::uint64_t round = 0; round < rounds; ++round) {
    const std::uint64_t mixed = left ^ (sim::bits4(seed_, sim::Stream::order, right, round)[0] & mask);
    left = right;
    right = mixed;
  }
  return left << half_bits_ | right;
}

}  // namespace detp::validate
