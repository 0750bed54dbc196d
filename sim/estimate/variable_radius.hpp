#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detp/sim/technique/technique.hpp"

namespace detp::sim {

/// The share of the photons that find radii for the others.
inline constexpr double pilot_share = 0.1;
/// No radius is more than so many times larger or smaller than the disc's own.
inline constexpr double most_growth = 2;

/// Radii from the hits h of a pilot, a search of some of the photons:
///
///     d_i = d √((m + 1) / (h_i + 1)),  d / most_growth <= d_i <= most_growth d
///
///   where  m   median of the hits of discs that some ray hits
///
/// So all discs meet about as many rays, and have about the same relative noise. Source: the idea is of M. Lastra, "Técnicas de estimación de
/// densidades para iluminación global" (2004): a radius for each point from the rays nearby; the rule is ours.
[[nodiscard]] std::vector<Disc> discs_of_pilot(std::span<const Disc> discs, std::span<const std::uint64_t> hits,
                                               std::uint64_t usual);
/// m; 0 if there are no hits: then radii stay.
[[nodiscard]] std::uint64_t usual_hits(std::span<const std::uint64_t> hits);

/// A tenth of the photons, drawn at random by their numbers, finds radii for all others, and another tenth finds those for the first: the radii
/// do not depend on the photons that they count, so given the radii the sum of both estimates is that by discs, and no photon is left
/// out. Errors are those of the sum of two independent parts. Throws std::invalid_argument unless both tenths have rays.
[[nodiscard]] Outcome estimate_with_variable_radius(const Problem& problem, const Candidate& candidate,
                                                    const RunOptions& options);

}  // namespace detp::sim
