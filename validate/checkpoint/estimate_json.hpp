#pragma once

#include <nlohmann/json.hpp>

#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Estimate, mean, standard_error)

}  // namespace detp::validate
