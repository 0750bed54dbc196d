#include "until_json.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/validate/base/json_bytes.hpp"
#include "detp/validate/checkpoint/counts_json.hpp"
#include "detp/validate/choice/candidate_json.hpp"

namespace detp::sim {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Vectors, cull, test)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SphereCounts, rebuilds, tests, listed)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Batches, count, rays, sum, squares)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Phases, prepare, order, build, search)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Outcome, hits, total_hits, counts, vectors, spheres, batches, seconds,
                                   standard_error, upper_bound)
}  // namespace detp::sim

namespace detp::validate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PairedBatches::State, unit, sums, pending, pending_photons, photons, pairs, earlier,
                                   products_of_squares, squares_of_products)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(UntilState, batches, rays, tests, looks, stops, stage_rays, stage_is_test,
                                   stage_is_last, stage_batches)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BatchErrors::State, unit, squares, largest, heaviest, unhit, most, photons)

void to_json(nlohmann::json& json, const BatchErrors& errors) { json = errors.state(); }
void from_json(const nlohmann::json& json, BatchErrors& errors) { errors.set_state(json.get<BatchErrors::State>()); }

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ExecutedUntil, outcome, errors, make_seconds, light)
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

}  // namespace detp::validate
