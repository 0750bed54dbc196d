#pragma once

#include <string>
#include <vector>

#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/regret/regret_summary.hpp"

namespace detp::cli {

/// The results of `bench --regret` in the three formats, with a summary for each number of threads in `threads`.
/// `missing` has the reasons why scenes were left out. Marked as stopped if a stop request ended it.
[[nodiscard]] Result report_regret(const validate::RegretResult& regret, const std::vector<int>& threads,
                                   const std::vector<std::string>& missing, const Screen& screen);

}  // namespace detp::cli
