#pragma once

#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/text/result.hpp"

namespace detp::cli {

/// The JSON of a command's result: schema, inputs, the result, provenance. Takes the inputs from `result`.
[[nodiscard]] Json envelope(const std::string& command, const CommonOptions& common, int threads, Result& result);

}  // namespace detp::cli
