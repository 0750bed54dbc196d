#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace detp::validate {

/// The times of one candidate on one number of threads, taken in rounds. The runs of a round follow each other, so that
/// the data are in the caches; their shortest time counts. Between two rounds other candidates run, so that a disturbance
/// by other programs rarely lasts for both.
class RoundTimes {
 public:
  void begin_round() {
    seconds_.push_back(std::numeric_limits<double>::infinity());
    preparing_.push_back(std::numeric_limits<double>::infinity());
  }

  void add(double seconds, double preparing) {
    seconds_.back() = std::min(seconds_.back(), seconds);
    preparing_.back() = std::min(preparing_.back(), preparing);
  }

  [[nodiscard]] std::size_t rounds() const { return seconds_.size(); }
  [[nodiscard]] bool timed() const { return !seconds_.empty() && seconds() > 0 && seconds() < unknown; }

  /// Whether the shortest times of two rounds agree. A time that only one round reached may be a stroke of luck, such as a
  /// processor that was faster for a moment; much longer times were disturbed.
  [[nodiscard]] bool agree() const {
    constexpr double tolerance = 0.05;
    double least = unknown;
    double next = unknown;
    for (const double one : seconds_) {
      next = std::min(next, std::max(one, least));
      least = std::min(least, one);
    }
    return next < unknown && next <= (1 + tolerance) * least;
  }

  [[nodiscard]] double seconds() const { return *std::min_element(seconds_.begin(), seconds_.end()); }
  [[nodiscard]] double preparing() const { return *std::min_element(preparing_.begin(), preparing_.end()); }
  /// The median of the rounds' seconds over the shortest; of two rounds 1.
  [[nodiscard]] double usual_over_shortest() const {
    std::vector<double> rounds = seconds_;
    const auto middle = rounds.begin() + static_cast<std::ptrdiff_t>((rounds.size() - 1) / 2);
    std::nth_element(rounds.begin(), middle, rounds.end());
    return *middle / seconds();
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::infinity();

  std::vector<double> seconds_;  ///< the shortest of each round
  std::vector<double> preparing_;
};

}  // namespace detp::validate
