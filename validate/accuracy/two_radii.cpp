#include "two_radii.hpp"

#include <cmath>
#include <stdexcept>

#include "error_split.hpp"

namespace detp::validate {

Estimate bias_by_two_radii(std::span<const std::vector<double>> wide, std::span<const std::vector<double>> narrow,
                           std::span<const double> weights) {
  if (wide.size() < 3 || wide.size() != narrow.size())
    throw std::invalid_argument("a bias by two radii needs at least 3 runs with each");
  const std::size_t discs = weights.size();
  const auto runs = static_cast<double>(wide.size());
  std::vector<double> mean(discs);
  for (const std::vector<double>& run : wide)
    for (std::size_t i = 0; i < discs; ++i) mean[i] += run[i] / runs;
  // The differences are runs whose reference is 0; relative errors need another one.
  std::vector<std::vector<double>> apart;
  for (std::size_t r = 0; r < wide.size(); ++r) {
    std::vector<double>& run = apart.emplace_back(mean);
    for (std::size_t i = 0; i < discs; ++i) run[i] += wide[r][i] - narrow[r][i];
  }
  const std::vector<double> exact(discs, 0.0);
  const ErrorSplit split = split_error(apart, {mean, exact, weights});
  constexpr double least = 16.0 / 9;
  constexpr double most = 4;
  constexpr double middle = 0.5 * (least + most);
  const double spread = 0.5 * (most - least) * std::max(0.0, split.bias_squared.mean) / 1.96;
  return {middle * split.bias_squared.mean, std::hypot(middle * split.bias_squared.standard_error, spread)};
}

}  // namespace detp::validate
