#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detp/sim/scene/scene.hpp"
#include "detp/validate/statistics/statistics.hpp"

/// Radii of pilots, and the bias by two radii where there is no scene to judge by.
namespace detp::validate {

/// Radii of variable-radius at some of a scene's samples, from the hits of other runs: a tenth of so short a run would not find the radii of a long
/// one. The median of the hits is that of discs at all samples of the scene, as in a run.
class PilotRadii {
 public:
  /// `places`: of samples that count, or of a random part of `population` such samples, rising. `relative`: radii of the scene's samples over the
  /// setting's; none: 1.
  PilotRadii(const sim::Scene& scene, std::span<const std::size_t> places, std::size_t population,
             std::span<const double> relative);

  /// At which hits are needed: those that count come first.
  [[nodiscard]] const std::vector<sim::Sample>& samples() const { return samples_; }
  [[nodiscard]] std::span<const double> relative() const { return relative_; }

  /// Radii over `radius` at the samples that count (sim::discs_of_pilot), from the hits of discs at samples().
  [[nodiscard]] std::vector<double> of(double radius, std::span<const std::uint64_t> hits) const;

 private:
  std::size_t counting_;
  std::vector<sim::Sample> samples_;
  std::vector<double> relative_;
};

/// bias² of estimates with discs of radius d, relative to their mean square, from R ≥ 3 runs of independent photons at the same discs with
/// radius d (`wide`) and d/2 (`narrow`):
///
///     bias(d) = c (E(d) - E(d/2))   c = 2 if the bias grows as d (edges), 4/3 if it grows as d² (smooth light)
///
/// Its mean is that of both c; its standard error has their difference, and the jackknife over the runs. Blur that both radii share is
/// not seen. `weights` of the discs, with sum 1. Throws std::invalid_argument for fewer runs, and if no light meets the discs.
[[nodiscard]] Estimate bias_by_two_radii(std::span<const std::vector<double>> wide,
                                         std::span<const std::vector<double>> narrow, std::span<const double> weights);

}  // namespace detp::validate
