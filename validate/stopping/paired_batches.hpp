#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

/// The noise of an irradiance over many discs, while it is estimated.
namespace detp::validate {

/// Relative noise of one run: root mean square over the discs by area, over the root mean square irradiance.
struct NoiseInterval {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// Mean of an irradiance over batches, by their photons.
struct BatchMean {
  /// Irradiance is in units of 2^unit, so that fourth powers neither overflow nor vanish: of extreme powers alone, else 0.
  int unit = 0;
  std::vector<double> sums;  ///< of irradiance times photons
  double photons = 0;

  /// Throws std::invalid_argument for a value that is not finite, and unless photons > 0.
  void add(std::span<const double> irradiance, double of_photons);
  /// 0 before the first batch.
  [[nodiscard]] std::vector<double> irradiance() const;
};

/// Sums the irradiance over batches of whole photons, and finds its noise from the differences of pairs of batches:
///
///     δ_ji = (x_1i - x_2i) √(n₁n₂/(n₁ + n₂))        Y_j = Σ_i w_i δ_ji²        of pair j; pairs are independent
///     noise² = σ²/(n B²)        σ² = mean of the Y_j        B² = Σ_i w_i m_i² - σ²/n
///
///   where  w    weights of the discs by area, with sum 1;     n₁, n₂  photons of the two batches;   n  photons of all batches
///          x_1i irradiance of disc i from batch 1, as if the batch were all photons;   m_i  from all batches
///
/// The square error of one run is about σ²/n times χ²_ν/ν, with ν = (tr C)²/tr C² for the covariance C of the discs' irradiance:
///
///     ν = Σ_jk Y_j Y_k / Σ_jk (Σ_i w_i δ_ji δ_ki)²        over different pairs j, k: unbiased above and below; 1 for one disc
///
/// σ² is known as χ²_m/m, m = 2 J mean²/variance of the J values Y_j, at most J ν. So the ratio of both has Fisher's distribution
/// F(ν, m), which gives the interval of one run's noise. For one disc and batches of many photons this is Student's t with J degrees
/// of freedom; with many independent discs the interval is narrow.
///
/// Asymptotic: it holds for batches with many photons. Light that no photon has met yet is in no batch, so it is in no interval.
/// Memory: eleven numbers for a disc, however many batches.
class PairedBatches {
 public:
  /// All that is known of the batches so far.
  struct State {
    BatchMean mean;
    std::vector<double> pending;              ///< first batch of a pair, in units of the mean
    double pending_photons = 0;               ///< 0: none
    std::vector<double> pairs;                ///< Y_j
    std::deque<std::vector<double>> earlier;  ///< δ of the last pairs
    double products_of_squares = 0;           ///< Σ Y_j Y_k
    double squares_of_products = 0;           ///< Σ (Σ w δ_j δ_k)²
  };

  /// Throws std::invalid_argument unless weights are >= 0, with a sum of 1 within 1e-6.
  explicit PairedBatches(std::vector<double> weights);

  [[nodiscard]] const State& state() const { return state_; }
  /// Goes on from the state of other batches over the same discs. Throws std::invalid_argument for another number of discs.
  void set_state(State state);

  /// The irradiance from one batch, as if it were all photons. Batches 1 and 2, 3 and 4, … are pairs. Throws
  /// std::invalid_argument for other than one value for each disc, for one that is not finite, and unless photons > 0.
  void add(std::span<const double> irradiance, double photons);

  [[nodiscard]] std::vector<double> irradiance() const { return state_.mean.irradiance(); }
  [[nodiscard]] double photons() const { return state_.mean.photons; }
  [[nodiscard]] std::size_t pairs() const { return state_.pairs.size(); }
  /// B², not below 0; beyond 1e308 infinite.
  [[nodiscard]] double mean_square() const;

  /// The noise of the irradiance so far. `high` alone is a bound with the confidence; with `low` it is an interval with 2 confidence - 1. Not
  /// finite with fewer than two pairs, and if no light was met.
  [[nodiscard]] NoiseInterval noise(double confidence) const;

  /// The number of photons at which `high` is expected to be as small as this.
  [[nodiscard]] double photons_for(double noise, double confidence) const;

 private:
  [[nodiscard]] double mean_square_in_units() const;
  [[nodiscard]] double variance() const;          ///< σ², in units
  [[nodiscard]] double discs_freedom() const;     ///< ν
  [[nodiscard]] double variance_freedom() const;  ///< m
  void compare_with_earlier(std::vector<double> difference, double square);

  std::vector<double> weights_;
  State state_;
};

}  // namespace detp::validate
