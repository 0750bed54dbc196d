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

/// Bytes of the sums over earlier blocks of photons, and, if the totals are the run's own, of those for standard errors.
[[nodiscard]] double sums_bytes(const Problem& problem, const RunOptions& options);

/// Bytes of a run's own totals, hits and irradiance (none if the totals are the caller's), and sums_bytes.
[[nodiscard]] double found_bytes(const Problem& problem, const RunOptions& options);

/// The number of ray 0's photon, if rays have no photon numbers.
[[nodiscard]] std::uint64_t first_photon(const RunOptions& options);

/// The blocks in which photons are summed: those of options.totals, or those for the problem's discs.
[[nodiscard]] PhotonBlocks photon_blocks(const Problem& problem, const RunOptions& options);

/// The block of photons of the problem's last ray.
[[nodiscard]] std::uint64_t last_block(const Problem& problem, const RunOptions& options);

}  // namespace detp::sim
