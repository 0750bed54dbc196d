#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace detp::sim {

/// From so many photons on, shares are equal: the bias is below 1/64 of the noise.
inline constexpr std::uint64_t many_photons = 4096;

/// The share of the light that each of n photons stands for, if photons were traced until their paths had `wanted` pieces or
/// more. `pieces` has the number of each photon's pieces; without the last one there are fewer than `wanted`.
///
/// A share of 1/n each has a bias of about 1/n: the last photon tends to have a long path. The first photon alone would have none.
/// Its mean over all orders in which the same photons would have been traced to the same end (Rao and Blackwell) has none either.
/// These are the orders that end with one of the m photons with more than Σ pieces - wanted pieces:
///
///     1/(n - 1)                of the other photons
///     (1 - 1/m)/(n - 1)        of these m
///
/// Returns nothing for shares of 1/n: if m = n, and from many_photons on.
[[nodiscard]] std::vector<double> photon_shares(std::span<const std::uint64_t> pieces, std::uint64_t wanted);

}  // namespace detp::sim
