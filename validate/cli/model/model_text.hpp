#pragma once

#include <string>

#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/closed_forms/closed_forms.hpp"

/// The answer of `detp model` for one workload, as text.
namespace detp::cli {

struct ModelText {
  bool with_costs = false;  ///< unit costs were given, so that times are seconds; else they are counts of tests
  bool verbose = false;     ///< with all that JSON has
  std::string workload;     ///< options that give detp validate the same workload; empty if they are not known
};

/// In sentences: T and its parts, the best parameters, k, what the other form says, and the command that counts what the formulas predict.
[[nodiscard]] std::string text_of(const validate::ModelRequest& request, const validate::ModelAnswer& answer,
                                  const ModelText& options, const Screen& screen);

}  // namespace detp::cli
