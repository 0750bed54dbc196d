#include "shared_batches.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/base/json.hpp"
#include "detp/validate/checkpoint/value_json.hpp"
#include "detp/validate/choice/candidate_json.hpp"

namespace detp::sim {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Vectors, cull, test)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SphereCounts, rebuilds, tests, listed)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Batches, count, rays, sum, squares)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Phases, prepare, order, build, search)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BandResults, irradiance, standard_error, upper_bound)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Outcome, hits, total_hits, counts, vectors, spheres, batches, seconds, irradiance,
                                   standard_error, upper_bound, further)
}  // namespace detp::sim

namespace detp::validate {
namespace {

/// A place, and the number of rays.
struct BatchTask {
  std::uint64_t batch = 0;
  std::uint64_t made = 0;
  std::uint64_t rays = 0;
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BatchTask, batch, made, rays)

}  // namespace

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BatchMean, unit, sums, photons)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PairedBatches::State, mean, pending, pending_photons, pairs, earlier,
                                   products_of_squares, squares_of_products)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(UntilState, batches, rays, tests, looks, stops, stage_rays, stage_is_test,
                                   stage_is_last, stage_batches)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BatchErrors::State, unit, squares, largest, heaviest, unhit, most, photons)

void to_json(nlohmann::json& json, const BatchErrors& errors) { json = errors.state(); }
void from_json(const nlohmann::json& json, BatchErrors& errors) { errors.set_state(json.get<BatchErrors::State>()); }

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BandBatches, irradiance, errors)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ExecutedUntil, outcome, bands, make_seconds, light)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Batch, irradiance, photons, rays)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FoundBatch, batch, outcome, make_seconds, light)

nlohmann::json json_of(const Candidate& candidate, const UntilState& state, const ExecutedUntil& so_far) {
  return {{"technique", name(candidate.technique)},
          {"parameters", to_json(candidate)},
          {"state", state},
          {"so_far", so_far}};
}

SavedRun saved_run_of(const nlohmann::json& json) {
  const std::string technique = json.at("technique");
  const auto* const known = std::ranges::find(all_techniques, technique, [](Technique one) { return name(one); });
  if (known == std::end(all_techniques)) throw std::invalid_argument("its technique is " + detp::quoted(technique));
  return {candidate_of(*known, json.at("parameters")), json.at("state").get<UntilState>(),
          json.at("so_far").get<ExecutedUntil>()};
}

std::string bytes_of(const FoundBatch& found) { return json_bytes(found); }

FoundBatch found_batch_of(const std::string& bytes) { return from_json_bytes<FoundBatch>(bytes); }

SharedBatches::SharedBatches(const Job& job, JobSearch& search, std::stop_token stop, sim::Ranks* ranks,
                             BandInQuestion band)
    : search_(search),
      rays_(job, std::move(stop)),
      band_(band),
      work_([this](const std::string& task) { return find(task); }) {
  if (ranks == nullptr) return;
  at_once_ = static_cast<std::size_t>(ranks->count());
  farm_.emplace(*ranks, work_);
}

std::optional<FoundBatch> SharedBatches::next(std::uint64_t rays, std::uint64_t following) {
  if (ahead_.empty()) {
    const auto place = farm_ ? rays_.next_place() : std::nullopt;
    if (!place) return next_here(rays);
    std::vector<std::string> tasks;
    for (std::uint64_t i = 0; i <= following && tasks.size() < at_once_; ++i)
      tasks.push_back(json_bytes(BatchTask{place->batch + i, place->made + i * rays, rays}));
    for (const std::string& found : farm_->all(tasks)) ahead_.push_back(found_batch_of(found));
  }
  FoundBatch batch = std::move(ahead_.front());
  ahead_.pop_front();
  rays_.count(batch.batch.rays);
  return batch;
}

std::optional<FoundBatch> SharedBatches::next_here(std::uint64_t rays) {
  const sim::Stopwatch watch;
  const std::optional<RayBatch> made = rays_.next(rays);
  const double make_seconds = watch.seconds();
  if (!made) return std::nullopt;
  return found_batch(*made, search_(made->rays), make_seconds, band_);
}

void SharedBatches::roll_call() {
  if (farm_) static_cast<void>(farm_->all(std::vector<std::string>(at_once_)));  // one empty task for each
}

std::string SharedBatches::find(const std::string& task) {
  if (task.empty()) return {};
  const BatchTask one = from_json_bytes<BatchTask>(task);
  const sim::Stopwatch watch;
  const RayBatch made = rays_.at({one.batch, one.made}, one.rays);
  const double make_seconds = watch.seconds();
  return bytes_of(found_batch(made, search_(made.rays), make_seconds, band_));
}

}  // namespace detp::validate
