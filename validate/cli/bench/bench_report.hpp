#pragma once

#include <span>
#include <string>
#include <vector>

#include "detp/validate/bench/summary.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"

namespace detp::cli {

/// The benchmark's results in the three formats: one result for each instruction set, on the same workloads. `missing` has the reasons why
/// scenes were left out. The exit code is `refuted` if one of our techniques found wrong hits, `stopped` if a stop request
/// ended the benchmark.
[[nodiscard]] Result report_bench(std::span<const validate::BenchResult> benches, const validate::BenchOptions& options,
                                  const std::vector<std::string>& missing, const Screen& screen);

}  // namespace detp::cli
