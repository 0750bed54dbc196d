#pragma once

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "detp/validate/statistics/statistics.hpp"

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
