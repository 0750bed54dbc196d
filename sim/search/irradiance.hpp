#pragma once

#include <span>

#include "outcome.hpp"
#include "totals.hpp"

namespace detp::sim {

/// With fewer photons than this on a disc, its standard error is not known well enough to be stated: only a bound is.
inline constexpr std::uint64_t fewest_photons = 10;

/// Bytes for each disc: its photon sums, its standard error and its bound.
constexpr double error_bytes = sizeof(PhotonSums) + 2 * sizeof(double);

/// Fills in the outcome's hits and irradiance from the totals, one for each disc; if the totals keep errors, standard_error
/// and upper_bound, too.
///
///     E = P / (π d²)        SE² = N/(N - 1) (Σ x² - P²/N) / (π d²)²
///
///   where  P  power of the rays that hit the disc
///          x  power that one photon brings to the disc: of all rays of its path that hit the disc
///          N  number of photons emitted; the sum goes over all of them
///          d  radius of the disc
///
/// SE² estimates the variance of a sum over N independent photons; a photon's rays are not independent of one another.
/// With fewer than 10 photons on the disc, SE is infinite.
///
/// The bound is one-sided, of 95 %. With k < 10 photons on the disc it is (P + w (u_k - k)) / (π d²), with u_k the upper
/// bound of a Poisson mean after k events, so that e^-u Σ_{i <= k} u^i/i! = 0.05, and w the largest power that one photon has
/// brought to this disc, but at least the largest power of a ray. It is exact where all photons bring w, as where none hits:
/// u_0 = -ln 0.05, and safe where they bring less. (A. Dobson et al., Statistics in Medicine 10, 1991, with the largest
/// weight in place of the root mean square one.) It is too low if photons can bring more than w, by several rays of a path. With 10
/// photons or more, it is E + 1.645 SE.
void finish(const Totals& totals, std::span<const Disc> discs, Outcome& outcome);

/// The same for one disc, `sums` and `photons` being those of the block of photons under way. The outcome's arrays must have
/// their size. `photons` may be null: then there is no standard error.
void finish_disc(const Totals& totals, const Disc& disc, std::size_t number, const DiscTotals& sums,
                 const PhotonSums* photons, Outcome& outcome);

/// Gives the outcome's arrays their size.
void resize_results(std::size_t discs, bool errors, Outcome& outcome);

}  // namespace detp::sim
