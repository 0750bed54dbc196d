#include "until_json.hpp"

#include <utility>

#include "detp/validate/base/json_bytes.hpp"
#include "detp/validate/checkpoint/counts_json.hpp"

namespace detp::sim {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Vectors, cull, test)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SphereCounts, rebuilds, tests, listed)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HitBatches, count, rays, hits, squares)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Phases, prepare, order, build, search)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Outcome, hits, total_hits, counts, vectors, spheres, batches, seconds)
}  // namespace detp::sim

namespace detp::validate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PairedBatches::State, sums, pending, pending_photons, photons, pairs, earlier,
                                   products_of_squares, squares_of_products)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(UntilState, batches, rays, tests, stage_rays, stage_is_test, stage_is_last,
                                   stage_batches)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ExecutedUntil, outcome, make_seconds)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Batch, irradiance, photons, rays)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FoundBatch, batch, outcome, make_seconds)

nlohmann::json json_of(const UntilState& state, const ExecutedUntil& so_far) {
  return {{"state", state}, {"so_far", so_far}};
}

SavedRun saved_run_of(const nlohmann::json& json) {
  return {json.at("state").get<UntilState>(), json.at("so_far").get<ExecutedUntil>()};
}

std::string bytes_of(const FoundBatch& found) { return json_bytes(found); }

FoundBatch found_batch_of(const std::string& bytes) { return from_json_bytes<FoundBatch>(bytes); }

}  // namespace detp::validate
