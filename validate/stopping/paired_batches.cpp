#include "paired_batches.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

constexpr double not_known = std::numeric_limits<double>::infinity();

}  // namespace

void BatchMean::add(std::span<const double> irradiance, double of_photons) {
  require_positive("number of photons of a batch", of_photons);
  for (const double one : irradiance) require_finite("irradiance of a batch", one);
  sums.resize(irradiance.size());
  constexpr int usual = 128;
  const auto is_zero = [](double one) { return one == 0; };
  if (std::ranges::all_of(sums, is_zero) && !std::ranges::all_of(irradiance, is_zero)) {
    const int exponent = std::ilogb(std::ranges::max(irradiance));
    unit = std::abs(exponent) > usual ? exponent : 0;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += of_photons * std::ldexp(irradiance[i], -unit);
  photons += of_photons;
}

std::vector<double> BatchMean::irradiance() const {
  std::vector<double> mean = sums;
  for (double& one : mean) one = std::ldexp(one / std::max(1.0, photons), unit);
  return mean;
}

PairedBatches::PairedBatches(std::vector<double> weights) : weights_(std::move(weights)) {
  state_.mean.sums.resize(weights_.size());
  double sum = 0;
  for (const double weight : weights_) {
    if (!(weight >= 0)) throw std::invalid_argument("weights of discs must not be below 0");
    sum += weight;
  }
  constexpr double rounding = 1e-6;
  if (!(std::abs(sum - 1) < rounding)) throw std::invalid_argument("weights of discs must add up to 1");
}

void PairedBatches::set_state(State state) {
  const auto fits = [&](const std::vector<double>& values) { return values.size() == weights_.size(); };
  if (!fits(state.mean.sums) || (state.pending_photons > 0 && !fits(state.pending)) ||
      !std::ranges::all_of(state.earlier, fits))
    throw std::invalid_argument("a state of batches over another number of discs");
  if (state.earlier.size() > state.pairs.size()) throw std::invalid_argument("a state of batches without its pairs");
  state_ = std::move(state);
}

void PairedBatches::add(std::span<const double> irradiance, double photons) {
  if (irradiance.size() != weights_.size()) throw std::invalid_argument("a batch needs the irradiance of every disc");
  state_.mean.add(irradiance, photons);
  const auto in_units = [&](std::size_t i) { return std::ldexp(irradiance[i], -state_.mean.unit); };
  if (state_.pending_photons == 0) {
    state_.pending.resize(irradiance.size());
    for (std::size_t i = 0; i < irradiance.size(); ++i) state_.pending[i] = in_units(i);
    state_.pending_photons = photons;
    return;
  }
  const double scale = std::sqrt(photons * state_.pending_photons / (photons + state_.pending_photons));
  double square = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    state_.pending[i] = scale * (in_units(i) - state_.pending[i]);
    square += weights_[i] * state_.pending[i] * state_.pending[i];
  }
  compare_with_earlier(std::move(state_.pending), square);
  state_.pending_photons = 0;
}

void PairedBatches::compare_with_earlier(std::vector<double> difference, double square) {
  for (std::size_t k = 0; k < state_.earlier.size(); ++k) {
    double product = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) product += weights_[i] * difference[i] * state_.earlier[k][i];
    state_.squares_of_products += product * product;
    state_.products_of_squares += square * state_.pairs[state_.pairs.size() - state_.earlier.size() + k];
  }
  state_.pairs.push_back(square);
  constexpr std::size_t most_kept = 8;
  state_.earlier.push_back(std::move(difference));
  if (state_.earlier.size() > most_kept) state_.earlier.pop_front();
}

double PairedBatches::variance() const {
  double sum = 0;
  for (const double one : state_.pairs) sum += one;
  return sum / static_cast<double>(state_.pairs.size());
}

double PairedBatches::mean_square() const { return std::ldexp(mean_square_in_units(), 2 * state_.mean.unit); }

double PairedBatches::mean_square_in_units() const {
  double square = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const double mean = state_.mean.sums[i] / photons();
    square += weights_[i] * mean * mean;
  }
  return state_.pairs.empty() ? square : std::max(0.0, square - variance() / photons());
}

double PairedBatches::discs_freedom() const {
  return state_.squares_of_products > 0 ? std::max(1.0, state_.products_of_squares / state_.squares_of_products)
                                        : static_cast<double>(weights_.size());
}

double PairedBatches::variance_freedom() const {
  const Estimate mean = batch_means(state_.pairs);
  const double most = discs_freedom() * static_cast<double>(state_.pairs.size());
  constexpr double least = 0.1;
  return mean.standard_error > 0 ? std::clamp(2 * std::pow(mean.mean / mean.standard_error, 2), least, most) : most;
}

NoiseInterval PairedBatches::noise(double confidence) const {
  require_ratio("confidence", confidence);
  const double square = state_.pairs.size() < 2 ? 0 : mean_square_in_units();
  if (!(square > 0) || !(variance() > 0)) return {not_known, 0, not_known};
  const boost::math::fisher_f ratio(discs_freedom(), variance_freedom());
  const double expected = variance() / photons() / square;
  return {std::sqrt(expected), std::sqrt(expected * boost::math::quantile(ratio, 1 - confidence)),
          std::sqrt(expected * boost::math::quantile(ratio, confidence))};
}

double PairedBatches::photons_for(double noise, double confidence) const {
  require_positive("noise", noise);
  const double high = this->noise(confidence).high;
  return photons() * (high / noise) * (high / noise);
}

}  // namespace detp::validate
