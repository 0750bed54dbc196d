#pragma once

#include "model_answer.hpp"

namespace detp::cli {

/// The answer in sentences: T and its parts, the best parameters, k, and what the other form says. `with_costs`: unit
/// costs were given, so that times are seconds; else they are counts of tests.
[[nodiscard]] std::string model_sentences(const ModelQuestion& question, const ModelAnswer& answer, bool with_costs);

/// The command, to be pasted, that counts what the formulas predict on `workload`, the options of one; empty if there is none.
[[nodiscard]] std::string counting_command(const ModelQuestion& question, const ModelAnswer& answer,
                                           const std::string& workload);

}  // namespace detp::cli
