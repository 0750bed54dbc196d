#pragma once

#include <nlohmann/json.hpp>

#include "claim.hpp"
#include "detp/validate/checkpoint/estimate_json.hpp"

namespace detp::validate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FormulaValue, form, source, value)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, id, quantity, technique, parameters, predictions, observed, batches,
                                   tolerance, lines, seconds)

}  // namespace detp::validate
