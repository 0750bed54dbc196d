#pragma once

#include <string_view>

#include "outcome.hpp"
#include "problem.hpp"

/// Memory that a run takes beside the problem's rays and discs: predicted, and refused before it is taken.
namespace detp::sim {

/// Whether so many bytes fit the memory beside the problem's rays and discs.
[[nodiscard]] bool fits_memory(double bytes, const Problem& problem);

/// Throws std::length_error where they do not.
void require_memory_for(std::string_view what, double bytes, const Problem& problem);

/// The same for so many bytes and half a MiB for all that is small; their sum.
double checked_bytes(std::string_view what, double bytes, const Problem& problem);

/// The same, and enters into the outcome that the run takes them.
void need_memory(std::string_view what, double bytes, const Problem& problem, Outcome& outcome);

/// Bytes of a run's own totals, hits and irradiance; none where its totals are another's.
[[nodiscard]] double found_bytes(const Problem& problem, const RunOptions& options);

}  // namespace detp::sim
