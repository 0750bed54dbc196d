#pragma once

#include "detp/validate/bench/bench_answer.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/regret/regret_answer.hpp"

/// The answers of `bench` and `bench --regret` in the three formats.
namespace detp::cli {

/// The exit code is `refuted` if one of our techniques found wrong hits, `stopped` if a stop request ended the benchmark.
[[nodiscard]] Result report(const validate::BenchAnswer& answer, const Screen& screen);

/// Marked as stopped if a stop request ended it.
[[nodiscard]] Result report(const validate::RegretAnswer& answer, const Screen& screen);

}  // namespace detp::cli
