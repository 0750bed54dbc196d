#pragma once

#include <nlohmann/json.hpp>

#include "replicates.hpp"

namespace detp::validate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AccuracySetting, estimator, radius, nearest)

}  // namespace detp::validate
