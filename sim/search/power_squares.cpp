#include "power_squares.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace detp::sim {

bool PowerSquares::needs_pairs(const Problem& problem, const Totals& before) {
  if (by_pairs_) return true;
  const double power = problem.rays().front().power;
  by_pairs_ = !problem.one_power() || (power_ != 0 && power != power_);
  if (by_pairs_) {
    squares_.assign(problem.discs().size(), 0.0);
    for (std::size_t disc = 0; disc < before.size(); ++disc)
      squares_[disc] = power_ * power_ * static_cast<double>(before[disc].hits);
  }
  power_ = power;
  return by_pairs_;
}

void PowerSquares::add(const Problem& problem, const std::vector<Pair>& pairs) {
  if (!by_pairs_) return;
  for (const Pair& pair : pairs) squares_[pair.disc] += std::pow(problem.rays()[pair.ray].power, 2);
}

void PowerSquares::finish(std::span<const Disc> discs, std::uint64_t rays, Outcome& outcome) const {
  const auto n = static_cast<double>(rays);
  outcome.standard_error.resize(discs.size());
  for (std::size_t disc = 0; disc < discs.size(); ++disc) {
    const double area = std::numbers::pi * discs[disc].radius * discs[disc].radius;
    const double power = outcome.irradiance[disc] * area;
    const double squares = by_pairs_ ? squares_[disc] : power_ * power_ * static_cast<double>(outcome.hits[disc]);
    outcome.standard_error[disc] =
        n > 1 ? std::sqrt(std::max(0.0, squares - power * power / n) * n / (n - 1)) / area : unbounded;
  }
}

}  // namespace detp::sim
