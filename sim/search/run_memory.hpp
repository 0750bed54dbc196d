#pragma once

#include <string_view>

#include "outcome.hpp"
#include "problem.hpp"

/// The memory of a run in addition to the problem's rays and discs: it is predicted, and checked before allocation.
namespace detp::sim {

/// Whether `bytes` fit in memory, in addition to the problem's rays and discs.
[[nodiscard]] bool fits_memory(double bytes, const Problem& problem);

/// Throws std::length_error if `bytes` do not fit in memory, in addition to the problem's rays and discs.
void require_memory_for(std::string_view what, double bytes, const Problem& problem);

/// Adds half a MiB for small allocations to `bytes`, and checks that the sum fits in memory. Returns the sum.
double checked_bytes(std::string_view what, double bytes, const Problem& problem);

/// Checks the memory as checked_bytes does. Outcome::bytes becomes the checked sum, unless it is larger already.
void add_checked_bytes(std::string_view what, double bytes, const Problem& problem, Outcome& outcome);

/// Bytes of a run's own totals, hits and irradiance; 0 if the totals are the caller's.
[[nodiscard]] double found_bytes(const Problem& problem, const RunOptions& options);

}  // namespace detp::sim
