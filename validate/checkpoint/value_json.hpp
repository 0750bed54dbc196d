#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "detp/model/vocabulary/counts.hpp"
#include "detp/sim/photons/light_ledger.hpp"
#include "detp/validate/statistics/statistics.hpp"

/// Counts, light, estimates and values that may be missing as JSON, for checkpoints.
namespace nlohmann {

/// Null for nothing.
template <class Value>
struct adl_serializer<std::optional<Value>> {
  static void to_json(json& json, const std::optional<Value>& value) {
    if (value)
      json = *value;
    else
      json = nullptr;
  }
  static void from_json(const json& json, std::optional<Value>& value) {
    value = json.is_null() ? std::nullopt : std::optional(json.get<Value>());
  }
};

}  // namespace nlohmann

namespace detp {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Counts<std::uint64_t>, loaded, segments, cull_tests, culls, listed, visits,
                                   disc_tests, doubtful, steps, nodes, references, placements, made, sorted, hits,
                                   bytes_touched)

}  // namespace detp

namespace detp::sim {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LightLedger, photons, power, landings)

}  // namespace detp::sim

namespace detp::validate {

/// A standard error that is not known is infinite, and null in JSON, which has no infinite numbers.
inline void to_json(nlohmann::json& json, const Estimate& estimate) {
  json = {{"mean", estimate.mean}, {"standard_error", nullptr}};
  if (std::isfinite(estimate.standard_error)) json["standard_error"] = estimate.standard_error;
}

inline void from_json(const nlohmann::json& json, Estimate& estimate) {
  json.at("mean").get_to(estimate.mean);
  const nlohmann::json& error = json.at("standard_error");
  estimate.standard_error = error.is_null() ? std::numeric_limits<double>::infinity() : error.get<double>();
}

}  // namespace detp::validate
