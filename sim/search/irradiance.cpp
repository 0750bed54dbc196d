#include "irradiance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detp/sim/base/page_pool.hpp"

namespace detp::sim {
namespace {

/// u_k - k, for k events.
constexpr std::array<double, 10> more_photons{
    2.995732273553991, 3.743864518390578, 4.295793621871989, 4.753656527932726, 5.153519026637571,
    5.513034908741531, 5.842395652420288, 6.148113802432119, 6.434649715196317, 6.705216422115463};
constexpr double one_sided = 1.6448536269514722;  ///< of a normal distribution, 95 %

}  // namespace

void resize_results(std::size_t discs, bool errors, Outcome& outcome, std::size_t bands) {
  resize_touched(outcome.hits, discs);
  outcome.further.resize(bands - 1);
  for (std::size_t band = 0; band < bands; ++band) {
    BandResults& results = outcome.band(band);
    resize_touched(results.irradiance, discs);
    resize_touched(results.standard_error, errors ? discs : 0);
    resize_touched(results.upper_bound, errors ? discs : 0);
  }
}

double heaviest_of_bound(double above, double squares) {
  for (std::size_t k = 0; k < more_photons.size(); ++k) {
    const double w = above / more_photons[k];
    const double as_heavy = squares > 0 ? std::min(fewest_photons - 1, std::ceil(squares / (w * w) - 1e-9)) : 0;
    if (as_heavy <= static_cast<double>(k)) return w;
  }
  return above / more_photons.back();
}

PowerError error_of_power(double power, const ErrorSums& sums, double heaviest, double photons) {
  constexpr double least = 0x1p-900;  // smaller sums may lack terms that vanished
  const double squares = sums.squares;
  const double unit = std::ldexp(1.0, sums.unit_exponent);
  const double w = unit * heaviest;
  const double largest = unit * sums.largest;
  const bool in_range = squares > least && squares < unbounded;  // not so if nothing hits
  const double variance = std::max(0.0, squares - (unit * power) * (unit * power) / photons) * photons / (photons - 1);
  const double error = std::sqrt(variance) / unit;
  if (in_range && squares * (1 + 1e-9) >= fewest_photons * largest * largest) return {error, power + one_sided * error};
  const double as_heavy = in_range ? squares / (w * w) : sums.photons;
  const double most = fewest_photons - 1;
  const auto k = static_cast<std::size_t>(std::min(most, std::ceil(as_heavy - 1e-9)));
  return {in_range && sums.photons > 1 ? error : unbounded, power + heaviest * more_photons[k]};
}

DiscResult result_of(const FoundSums& found, const ErrorSums* errors, double heaviest, double photons, double scale) {
  const double area = std::numbers::pi * found.radius * found.radius / scale;
  DiscResult result{.hits = found.hits, .irradiance = found.power / area};
  if (errors == nullptr) return result;
  const PowerError error = error_of_power(found.power, *errors, heaviest, photons);
  result.standard_error = error.standard_error / area;
  result.upper_bound = error.upper_bound / area;
  return result;
}

DiscResult result_of(const Outcome& outcome, std::size_t disc, std::size_t band) {
  const BandResults& results = outcome.band(band);
  DiscResult result{.hits = outcome.hits[disc], .irradiance = results.irradiance[disc]};
  if (results.standard_error.empty()) return result;
  result.standard_error = results.standard_error[disc];
  result.upper_bound = results.upper_bound[disc];
  return result;
}

void finish_disc(const Totals& totals, const Disc& disc, std::size_t number, const DiscTotals& sums,
                 const PhotonSums* photons, double heaviest, BandResults& results) {
  const FoundSums found{sums.hits, totals.power(number, sums), disc.radius};
  ErrorSums errors;
  if (photons != nullptr)
    errors = {totals.squares(number, *photons), photons->largest, photons->photons, totals.unit_exponent()};
  const DiscResult result = result_of(found, photons != nullptr ? &errors : nullptr, heaviest,
                                      static_cast<double>(totals.photons()), totals.scale());
  results.irradiance[number] = result.irradiance;
  if (photons == nullptr) return;
  results.standard_error[number] = result.standard_error;
  results.upper_bound[number] = result.upper_bound;
}

double heaviest_photon(std::span<const PhotonSums> discs, double largest_power) {
  for (const PhotonSums& disc : discs) largest_power = std::max(largest_power, disc.largest);
  return largest_power;
}

void finish(const Totals& totals, std::span<const Disc> discs, Outcome& outcome) {
  resize_results(discs.size(), totals.keeps_errors(), outcome, totals.bands());
  for (std::size_t disc = 0; disc < discs.size(); ++disc) outcome.hits[disc] = totals[disc].hits;
  for (std::size_t band = 0; band < totals.bands(); ++band) {
    const Totals& sums = totals.band(band);
    const double heaviest = heaviest_photon(sums.photon_sums(), sums.largest_power());
    for (std::size_t disc = 0; disc < discs.size(); ++disc)
      finish_disc(sums, discs[disc], disc, sums[disc], sums.keeps_errors() ? &sums.photon_sums(disc) : nullptr,
                  heaviest, outcome.band(band));
  }
}

}  // namespace detp::sim
