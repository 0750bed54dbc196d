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

PairedBatches::PairedBatches(std::vector<double> weights) : weights_(std::move(weights)), sums_(weights_.size()) {
  double sum = 0;
  for (const double weight : weights_) {
    if (!(weight >= 0)) throw std::invalid_argument("weights of discs must not be below 0");
    sum += weight;
  }
  constexpr double rounding = 1e-6;
  if (!(std::abs(sum - 1) < rounding)) throw std::invalid_argument("weights of discs must add up to 1");
}

void PairedBatches::add(std::span<const double> irradiance, double photons) {
  if (irradiance.size() != weights_.size()) throw std::invalid_argument("a batch needs the irradiance of every disc");
  require_positive("number of photons of a batch", photons);
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += photons * irradiance[i];
  photons_ += photons;
  if (pending_photons_ == 0) {
    pending_.assign(irradiance.begin(), irradiance.end());
    pending_photons_ = photons;
    return;
  }
  const double scale = std::sqrt(photons * pending_photons_ / (photons + pending_photons_));
  double square = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    pending_[i] = scale * (irradiance[i] - pending_[i]);
    square += weights_[i] * pending_[i] * pending_[i];
  }
  compare_with_earlier(std::move(pending_), square);
  pending_photons_ = 0;
}

void PairedBatches::compare_with_earlier(std::vector<double> difference, double square) {
  for (std::size_t k = 0; k < earlier_.size(); ++k) {
    double product = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) product += weights_[i] * difference[i] * earlier_[k][i];
    squares_of_products_ += product * product;
    products_of_squares_ += square * pairs_[pairs_.size() - earlier_.size() + k];
  }
  pairs_.push_back(square);
  constexpr std::size_t most_kept = 8;
  earlier_.push_back(std::move(difference));
  if (earlier_.size() > most_kept) earlier_.pop_front();
}

std::vector<double> PairedBatches::irradiance() const {
  std::vector<double> mean = sums_;
  for (double& one : mean) one /= std::max(1.0, photons_);
  return mean;
}

double PairedBatches::variance() const {
  double sum = 0;
  for (const double one : pairs_) sum += one;
  return sum / static_cast<double>(pairs_.size());
}

double PairedBatches::mean_square() const {
  double square = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i)
    square += weights_[i] * (sums_[i] / photons_) * (sums_[i] / photons_);
  return pairs_.empty() ? square : std::max(0.0, square - variance() / photons_);
}

double PairedBatches::discs_freedom() const {
  return squares_of_products_ > 0 ? std::max(1.0, products_of_squares_ / squares_of_products_)
                                  : static_cast<double>(weights_.size());
}

double PairedBatches::variance_freedom() const {
  const Estimate mean = batch_means(pairs_);
  const double most = discs_freedom() * static_cast<double>(pairs_.size());
  constexpr double least = 0.1;
  return mean.standard_error > 0 ? std::clamp(2 * std::pow(mean.mean / mean.standard_error, 2), least, most) : most;
}

NoiseInterval PairedBatches::noise(double confidence) const {
  require_ratio("confidence", confidence);
  const double square = pairs_.size() < 2 ? 0 : mean_square();
  if (!(square > 0) || !(variance() > 0)) return {not_known, 0, not_known};
  const boost::math::fisher_f ratio(discs_freedom(), variance_freedom());
  const double expected = variance() / photons_ / square;
  return {std::sqrt(expected), std::sqrt(expected * boost::math::quantile(ratio, 1 - confidence)),
          std::sqrt(expected * boost::math::quantile(ratio, confidence))};
}

double PairedBatches::photons_for(double noise, double confidence) const {
  require_positive("noise", noise);
  const double high = this->noise(confidence).high;
  return photons_ * (high / noise) * (high / noise);
}

}  // namespace detp::validate
