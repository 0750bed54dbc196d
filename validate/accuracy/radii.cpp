#include "radii.hpp"

#include <cmath>
#include <stdexcept>

#include "detp/sim/estimate/variable_radius.hpp"
#include "error_split.hpp"
#include "judged_samples.hpp"
#include "replicates.hpp"

namespace detp::validate {

PilotRadii::PilotRadii(const sim::Scene& scene, std::span<const std::size_t> places, std::size_t population,
                       std::span<const double> relative)
    : counting_(places.size()) {
  constexpr std::size_t most_for_median = 1000;
  std::vector<std::size_t> all(places.begin(), places.end());
  if (population < scene.samples.size()) {
    const std::vector<double> equal(scene.samples.size(), 1.0);
    const JudgedSamples everywhere = judged_samples(scene, most_for_median, equal);
    all.insert(all.end(), everywhere.places.begin(), everywhere.places.end());
  }
  for (const std::size_t place : all) {
    samples_.push_back(scene.samples[place]);
    if (!relative.empty()) relative_.push_back(relative[place]);
  }
}

std::vector<double> PilotRadii::of(double radius, std::span<const std::uint64_t> hits) const {
  const bool all_count = counting_ == samples_.size();
  const std::uint64_t usual = sim::usual_hits(all_count ? hits : hits.subspan(counting_));
  const std::vector<sim::Disc> discs =
      discs_at(std::span(samples_).first(counting_), radius,
               relative_.empty() ? std::span<const double>() : std::span(relative_).first(counting_));
  std::vector<double> found;
  for (const sim::Disc& disc : sim::discs_of_pilot(discs, hits.first(counting_), usual))
    found.push_back(disc.radius / radius);
  return found;
}

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
