#include "scalar_rules.hpp"

#include <array>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>

#include "detp/validate/statistics/statistics.hpp"
#include "detp/validate/stopping/run_until.hpp"

namespace detp::tools {
namespace {

double squared(double x) { return x * x; }

double allowed(const ScalarTarget& target) { return 1 - target.confidence; }

double total(const Counts& counts) {
  double sum = 0;
  for (const double count : counts) sum += count;
  return sum;
}

double mean_of(const Distribution& distribution, const Counts& counts) {
  double sum = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) sum += counts[i] * distribution.values[i];
  return sum / total(counts);
}

/// All values so far.
class Sums {
 public:
  explicit Sums(const Distribution& distribution) : distribution_(distribution), counts_(distribution.values.size()) {}
  void add(const Counts& counts) {
    for (std::size_t i = 0; i < counts.size(); ++i) counts_[i] += counts[i];
  }
  [[nodiscard]] double size() const { return total(counts_); }
  [[nodiscard]] double mean() const { return mean_of(distribution_, counts_); }
  [[nodiscard]] double variance() const {
    double sum = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) sum += counts_[i] * squared(distribution_.values[i]);
    return std::max(0.0, sum / size() - squared(mean()));
  }

 private:
  const Distribution& distribution_;
  Counts counts_;
};

std::uint64_t whole(double x) { return static_cast<std::uint64_t>(std::max(1.0, std::ceil(x))); }

std::optional<ScalarEnd> fixed(Stream& stream, const ScalarTarget& target) {
  const double size = best_fixed_size(stream.distribution(), target);
  return ScalarEnd{std::ceil(size), mean_of(stream.distribution(), stream.next(whole(size)))};
}

/// Looks after each batch, from `least` batches on, at the standard error over the batches.
template <std::size_t least>
std::optional<ScalarEnd> naive(Stream& stream, const ScalarTarget& target) {
  const double width = boost::math::quantile(boost::math::normal(), 1 - allowed(target) / 2);
  std::vector<double> means;
  while (true) {
    means.push_back(mean_of(stream.distribution(), stream.next(whole(target.look))));
    if (means.size() < least) continue;
    const validate::Estimate found = validate::batch_means(means);
    if (width * found.standard_error <= target.error * found.mean)
      return ScalarEnd{std::ceil(target.look) * static_cast<double>(means.size()), found.mean};
  }
}

std::optional<ScalarEnd> gamma_bernoulli(Stream& stream, const ScalarTarget& target) {
  if (stream.distribution().values.size() != 2) return std::nullopt;
  const std::uint64_t hits = gamma_bernoulli_hits(target.error, target.confidence);
  const double values = stream.values_to_hit(hits);
  std::gamma_distribution<double> sum_of_exponentials(values);
  return ScalarEnd{values, (static_cast<double>(hits) - 1) / sum_of_exponentials(stream.random())};
}

std::optional<ScalarEnd> normal_mixture(Stream& stream, const ScalarTarget& target) {
  const double alpha = allowed(target);
  const double tuned_for = 10 * target.first;
  const double rho2 = (-2 * std::log(alpha) + std::log(-2 * std::log(alpha)) + 1) / tuned_for;
  Sums sums(stream.distribution());
  sums.add(stream.next(whole(target.first)));
  while (true) {
    const double n = sums.size();
    const double radius =
        std::sqrt(sums.variance() * 2 * (n * rho2 + 1) / (n * n * rho2) * std::log(std::sqrt(n * rho2 + 1) / alpha));
    if (sums.mean() > 0 && radius <= target.error * sums.mean()) return ScalarEnd{n, sums.mean()};
    sums.add(stream.next(whole(target.look)));
  }
}

/// Capital of bets against each mean of a grid around the true one; the grid is the only use of the truth.
class Betting {
 public:
  Betting(const Distribution& distribution, const ScalarTarget& target) : distribution_(distribution), target_(target) {
    constexpr double reach = 5;
    for (int i = 0; i <= cells; ++i)
      means_.push_back(distribution.mean() * (1 + target.error * reach * (2.0 * i / cells - 1)));
    up_.resize(means_.size());
    down_.resize(means_.size());
  }

  /// `variance` is that of the values before these; `size` is the number of all with these.
  void add(const Counts& counts, double variance, double size) {
    const double bet = std::sqrt(2 * std::log(2 / allowed(target_)) / (variance * size * std::log(1 + size)));
    constexpr double most = 0.5;
    for (std::size_t j = 0; j < means_.size(); ++j) {
      const double m = means_[j];
      const double above = std::min(bet, most / m);
      const double below = std::min(bet, most / (1 - m));
      for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] == 0) continue;
        up_[j] += counts[i] * std::log1p(above * (distribution_.values[i] - m));
        down_[j] += counts[i] * std::log1p(-below * (distribution_.values[i] - m));
      }
    }
    const double limit = std::log(2 / allowed(target_));
    for (std::size_t j = 0; j < means_.size(); ++j)
      if (std::max(up_[j], down_[j]) >= limit) excluded_[j] = true;
  }

  /// The estimate with the least largest error over the means that are left, if it is small enough.
  [[nodiscard]] std::optional<double> estimate() const {
    if (!excluded_.front() || !excluded_.back()) return std::nullopt;
    std::size_t first = 0;
    while (first < excluded_.size() && excluded_[first]) ++first;
    if (first == excluded_.size()) return means_[excluded_.size() / 2];
    std::size_t last = excluded_.size() - 1;
    while (excluded_[last]) --last;
    const double low = means_[first - 1];
    const double high = means_[last + 1];
    if ((high - low) / (high + low) > target_.error) return std::nullopt;
    return 2 * low * high / (low + high);
  }

 private:
  static constexpr int cells = 250;
  const Distribution& distribution_;
  const ScalarTarget& target_;
  std::vector<double> means_;
  std::vector<double> up_;  ///< logarithms of capitals
  std::vector<double> down_;
  std::vector<bool> excluded_ = std::vector<bool>(cells + 1);
};

std::optional<ScalarEnd> betting(Stream& stream, const ScalarTarget& target) {
  Sums sums(stream.distribution());
  Betting bets(stream.distribution(), target);
  double variance = 0.25;
  for (double next = target.first;; next = target.look) {
    const Counts counts = stream.next(whole(next));
    bets.add(counts, variance, sums.size() + total(counts));
    sums.add(counts);
    if (const auto found = bets.estimate()) return ScalarEnd{sums.size(), *found};
    variance = (0.25 + sums.size() * sums.variance()) / (1 + sums.size());
  }
}

constexpr int batches = 32;

/// Mean of so many values with the half width of its interval by Student's t over 32 batches.
struct BatchedMean {
  double size = 0;
  double mean = 0;
  double half_width = 0;
};

BatchedMean batched(const std::vector<double>& means, double size, double alpha) {
  const validate::Estimate found = validate::batch_means(means);
  return {size, found.mean, validate::interval_width(alpha, 1, batches) * found.standard_error};
}

std::optional<ScalarEnd> doubled(Stream& stream, const ScalarTarget& target) {
  double each = std::ceil(target.first / batches);
  std::vector<double> means;
  for (int i = 0; i < batches; ++i) means.push_back(mean_of(stream.distribution(), stream.next(whole(each))));
  for (int look = 1;; ++look) {
    const BatchedMean found = batched(means, batches * each, allowed(target) / (look * (look + 1)));
    if (found.mean > 0 && found.half_width <= target.error * found.mean) return ScalarEnd{found.size, found.mean};
    // Twice the values: old batches are joined by two, new ones follow.
    for (int i = 0; i < batches / 2; ++i) means[i] = (means[2 * i] + means[2 * i + 1]) / 2;
    each *= 2;
    for (int i = batches / 2; i < batches; ++i) means[i] = mean_of(stream.distribution(), stream.next(whole(each)));
  }
}

std::optional<ScalarEnd> two_stages(Stream& stream, const ScalarTarget& target) {
  const double each = std::ceil(target.first / batches);
  std::vector<double> means;
  for (int i = 0; i < batches; ++i) means.push_back(mean_of(stream.distribution(), stream.next(whole(each))));
  const BatchedMean pilot = batched(means, batches * each, allowed(target));
  if (!(pilot.mean > 0)) return ScalarEnd{pilot.size, 0};
  const double size = std::ceil(pilot.size * squared(pilot.half_width / (target.error * pilot.mean)));
  if (size <= pilot.size) return ScalarEnd{pilot.size, pilot.mean};
  const double second = mean_of(stream.distribution(), stream.next(whole(size - pilot.size)));
  return ScalarEnd{size, (pilot.size * pilot.mean + (size - pilot.size) * second) / size};
}

std::optional<ScalarEnd> pairs_of_batches(Stream& stream, const ScalarTarget& target) {
  const validate::NextBatch next = [&](std::uint64_t count, std::uint64_t) {
    return std::optional(
        validate::Batch{{mean_of(stream.distribution(), stream.next(count))}, static_cast<double>(count), count});
  };
  const validate::UntilResult found = validate::run_until(
      next, {1.0}, {.error = target.error, .confidence = target.confidence},
      {.most_rays = 1e15, .first_rays = whole(target.first), .most_in_batch = std::uint64_t{1} << 50});
  return ScalarEnd{found.photons, found.irradiance[0]};
}

constexpr std::array all_rules{
    ScalarRule{"known variance", "a size fixed before", fixed},
    ScalarRule{"each batch, from 2", "naive", naive<2>},
    ScalarRule{"each batch, from 5", "naive", naive<5>},
    ScalarRule{"Gamma Bernoulli", "huber2017", gamma_bernoulli},
    ScalarRule{"normal mixture", "howard2021, waudbysmith2024: asymptotic", normal_mixture},
    ScalarRule{"betting", "waudbysmith2023: hedged capital", betting},
    ScalarRule{"two stages", "stein1945, Student's t of 32 batches", two_stages},
    ScalarRule{"doubled sizes", "error spent 1/(j(j + 1)), Student's t of 32 batches", doubled},
    ScalarRule{"pairs of batches", "run_until", pairs_of_batches}};

}  // namespace

std::span<const ScalarRule> scalar_rules() { return all_rules; }

double best_fixed_size(const Distribution& distribution, const ScalarTarget& target) {
  const double width = boost::math::quantile(boost::math::normal(), 1 - allowed(target) / 2);
  return distribution.relative_variance() * squared(width / target.error);
}

std::uint64_t gamma_bernoulli_hits(double error, double confidence) {
  const auto kept = [&](std::uint64_t hits) {
    const auto k = static_cast<double>(hits);
    return boost::math::gamma_p(k, (k - 1) / (1 - error)) - boost::math::gamma_p(k, (k - 1) / (1 + error));
  };
  std::uint64_t most = 2;
  while (kept(most) < confidence) most *= 2;
  std::uint64_t least = most / 2;
  while (most - least > 1) {
    const std::uint64_t middle = least + (most - least) / 2;
    (kept(middle) < confidence ? least : most) = middle;
  }
  return most;
}

}  // namespace detp::tools
