#include "pilot_radii.hpp"

#include "detp/sim/estimate/variable_radius.hpp"
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
    const JudgedSamples everywhere = judged_samples(scene, equal, most_for_median);
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

}  // namespace detp::validate
