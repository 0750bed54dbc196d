#pragma once

#include <nlohmann/json_fwd.hpp>

#include "calibration_key.hpp"

namespace detp::validate {

[[nodiscard]] nlohmann::ordered_json to_json(const CalibrationKey& key);

/// Throws nlohmann::json::exception if a value is missing or of another type.
[[nodiscard]] CalibrationKey key_of(const nlohmann::ordered_json& json);

}  // namespace detp::validate
