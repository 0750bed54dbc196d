#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "detp/validate/bench/summary.hpp"

namespace detp::cli {

/// What the benchmark found, in the three formats; `missing` says why scenes were left out. The code is `refuted` if
/// one of ours found other hits than the right ones, `stopped` if not all was run.
[[nodiscard]] Result report_bench(const validate::BenchResult& bench, const validate::BenchOptions& options,
                                  const std::vector<std::string>& missing);

}  // namespace detp::cli
