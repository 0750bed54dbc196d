#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "detp/model/vocabulary/counts.hpp"
#include "detp/sim/photons/light_ledger.hpp"

namespace detp {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Counts<std::uint64_t>, loaded, segments, cull_tests, culls, listed, visits,
                                   disc_tests, doubtful, steps, nodes, references, placements, made, sorted, hits,
                                   bytes_touched)

}  // namespace detp

namespace detp::sim {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LightLedger, photons, power, landings)

}  // namespace detp::sim
