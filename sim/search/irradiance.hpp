#pragma once

#include <span>

#include "outcome.hpp"
#include "totals.hpp"

namespace detp::sim {

/// A standard error is weak if one photon brings more than one part in so many of Σ x² to the disc (finish).
inline constexpr double fewest_photons = 10;

/// Bytes for each disc: its photon sums, its standard error and its bound.
constexpr double error_bytes = sizeof(PhotonSums) + 2 * sizeof(double);

/// Fills in the outcome's hits and irradiance from the totals, one for each disc; if the totals keep errors, standard_error
/// and upper_bound, too.
///
///     E = P / (π d²)        SE² = N/(N - 1) (Σ x² - P²/N) / (π d²)²
///
///   where  P  power of the rays that hit the disc, and all x, times the scale of the totals
///          x  power that one photon brings to the disc: of all rays of its path that hit the disc
///          N  number of photons emitted; the sum goes over all of them
///          d  radius of the disc
///
/// SE² estimates the variance of a sum over N independent photons; a photon's rays are not independent of one another.
/// SE is infinite, for not known, if fewer than two photons hit the disc. It is weak if one photon brings more than a tenth of Σ x²: so
/// always if fewer than 10 photons hit the disc, and exactly then if all bring the same power. Where a few photons bring most of the power, as
/// on a caustic, intervals of ± 1.96 SE hold less often than they should.
///
/// The bound is one-sided, of 95 %. It is E + 1.645 SE; where SE is weak or not known, (P + w (u_k - k)) / (π d²), which is at least
/// E + 2.1 SE, with
///
///   where  w    largest power that one photon has brought to one disc, any of them, but at least the largest power of a ray
///          k    Σ x² / w², rounded up, at most 9: the number of photons if all were as heavy
///          u_k  upper bound of a Poisson mean after k events: e^-u Σ_{i <= k} u^i/i! = 0.05
///
/// It is exact where all photons bring w, also where none hits: u_0 = -ln 0.05. Where some bring less, it is larger than
/// that of A. Dobson et al., Statistics in Medicine 10, 1991, which has the root mean square weight in place of w. Where
/// photons bring many rays to a disc, w of this disc alone would be too low: such bounds held in 93 % of the cases on a
/// caustic, where those with w of all discs hold in 99 % and are 1.5 times as large in the median.
void finish(const Totals& totals, std::span<const Disc> discs, Outcome& outcome);

/// The same for one disc and band, `sums` and `photons` being those of the block of photons under way. The arrays must have
/// their size. `photons` may be null: then there is no standard error. `heaviest` is w.
void finish_disc(const Totals& totals, const Disc& disc, std::size_t number, const DiscTotals& sums,
                 const PhotonSums* photons, double heaviest, BandResults& results);

/// What was found of one disc.
struct FoundSums {
  std::uint64_t hits = 0;
  double power = 0;  ///< P
  double radius = 0;
};

/// What its standard error needs.
struct ErrorSums {
  double squares = 0;  ///< Σ (u x)²
  double largest = 0;  ///< largest x
  std::uint32_t photons = 0;
  std::int32_t unit_exponent = 0;  ///< of u
};

struct DiscResult {
  std::uint64_t hits = 0;
  double irradiance = 0;
  double standard_error = unbounded;  ///< infinite: not known
  double upper_bound = unbounded;
};

/// Of a disc in an outcome.
[[nodiscard]] DiscResult result_of(const Outcome& outcome, std::size_t disc, std::size_t band = 0);

/// Whether the standard error, if it is known at all, is weak (finish): the bound says so.
[[nodiscard]] inline bool is_weak(const DiscResult& result) {
  return !(result.upper_bound <= result.irradiance + 1.9 * result.standard_error) || result.standard_error == unbounded;
}

/// By the rules of `finish`. `errors` may be null: then there is no standard error. `heaviest` is w, `photons` N, `scale` that
/// of the totals.
[[nodiscard]] DiscResult result_of(const FoundSums& found, const ErrorSums* errors, double heaviest, double photons,
                                   double scale);

/// A standard error and a one-sided bound of 95 %, by the rules of `finish`, in the unit of the power.
struct PowerError {
  double standard_error = unbounded;  ///< infinite: not known
  double upper_bound = 0;
};

/// Of the sum P of what `photons` emitted photons bring. `heaviest` is w.
[[nodiscard]] PowerError error_of_power(double power, const ErrorSums& sums, double heaviest, double photons);

/// w of a weak error, from its bound less the power, and Σ x²: the largest that fits (finish).
[[nodiscard]] double heaviest_of_bound(double above, double squares);

/// w, from the sums of all discs and the largest power of a ray.
[[nodiscard]] double heaviest_photon(std::span<const PhotonSums> discs, double largest_power);

/// Gives the outcome's arrays their size.
void resize_results(std::size_t discs, bool errors, Outcome& outcome, std::size_t bands = 1);

}  // namespace detp::sim
