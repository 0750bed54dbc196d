#include "batch_errors.hpp"

#include <algorithm>
#include <cmath>

namespace detp::validate {
namespace {

/// The largest of `count` numbers >= 0 with this sum and sum of squares is at most so large. Source: P. Samuelson, "How deviant can you be?",
/// Journal of the American Statistical Association 63, 1968.
double largest_of(double sum, double squares, double count) {
  const double mean = sum / count;
  return mean + std::sqrt((count - 1) * std::max(0.0, squares / count - mean * mean));
}

}  // namespace

void BatchErrors::add(const sim::BandResults& batch, std::span<const std::uint64_t> hits, double photons) {
  const std::size_t discs = batch.irradiance.size();
  if (empty()) {
    state_.photons.resize(discs);
    for (auto* values : {&state_.squares, &state_.largest, &state_.heaviest, &state_.unhit}) values->resize(discs);
  }
  if (const double most = std::ranges::max(batch.irradiance) * photons;
      most > 0 && std::ranges::none_of(state_.squares, [](double square) { return square > 0; }))
    state_.unit = -std::ilogb(most);
  const auto in_units = [&](double x) { return std::ldexp(x, state_.unit); };
  // w of the batch over that of the first one, by a disc that neither hits
  double ratio = 1;
  for (std::size_t i = 0; state_.most > 0 && i < discs; ++i)
    if (!(batch.irradiance[i] > 0) && state_.unhit[i] > 0) {
      ratio = sim::heaviest_of_bound(in_units(photons * batch.upper_bound[i]), 0) / in_units(state_.unhit[i]);
      break;
    }
  for (std::size_t i = 0; i < discs; ++i) {
    const sim::DiscResult found{hits[i], batch.irradiance[i], batch.standard_error[i], batch.upper_bound[i]};
    const double sum = photons * found.irradiance;
    const bool one = !(found.standard_error < sim::unbounded);
    double square = 0;
    if (sum > 0) {
      const double whole = std::pow(in_units(sum), 2);
      const double error = one ? 0 : std::pow(in_units(photons * found.standard_error), 2);
      // as sim::finish, backwards
      square = one ? whole : error * (photons - 1) / photons + whole / photons;
      state_.squares[i] += square;
      state_.photons[i] = std::min(2, state_.photons[i] + (one ? 1 : 2));
    }
    if (!is_weak(found) || !std::isfinite(found.upper_bound)) continue;
    const double above = in_units(photons * (found.upper_bound - found.irradiance));
    const double heaviest = sim::heaviest_of_bound(above, square);
    state_.heaviest[i] = std::max(state_.heaviest[i], std::ldexp(heaviest / ratio, -state_.unit));
    if (!(square > 0)) {
      if (state_.unhit[i] == 0) state_.unhit[i] = std::ldexp(heaviest / ratio, -state_.unit);
      continue;
    }
    const double largest =
        largest_of(in_units(sum), square, static_cast<double>(std::max<std::uint64_t>(1, found.hits)));
    state_.largest[i] =
        std::max(state_.largest[i], std::ldexp(std::min({heaviest, std::sqrt(square), largest}), -state_.unit));
  }
  state_.most = std::max(state_.most, ratio);
}

std::vector<sim::PowerError> BatchErrors::of(std::span<const double> irradiance, double photons) const {
  std::vector<sim::PowerError> all;
  for (std::size_t i = 0; i < state_.squares.size(); ++i) {
    const sim::ErrorSums sums{state_.squares[i], state_.largest[i], static_cast<std::uint32_t>(state_.photons[i]),
                              state_.unit};
    const double sum = photons * irradiance[i];
    const double heaviest = state_.heaviest[i] * state_.most;
    sim::PowerError& error = all.emplace_back(sim::error_of_power(sum, sums, heaviest, photons));
    if (!(state_.squares[i] > 0) && !(state_.heaviest[i] > 0)) error.upper_bound = sim::unbounded;
    error.standard_error /= photons;
    error.upper_bound /= photons;
  }
  return all;
}

}  // namespace detp::validate
