#pragma once

#include <cstddef>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/scene/scene.hpp"
#include "detp/sim/scene/selection.hpp"

/// Where errors of estimates are taken.
namespace detp::validate {

/// Share of the mesh's area that scatters no light diffusely, but as mirrors or glass do. A renderer has no irradiance samples there; light
/// that is caught in glass for thousands of reflections would make most of the error.
[[nodiscard]] double mirror_share(const sim::Mesh& mesh);
/// What is said of it; empty if it is 0.
[[nodiscard]] std::string mirror_notice(double share);

enum class Surfaces {
  without_mirrors,  ///< those of mirror_share count only if there are no others
  all
};

/// Area around each of the scene's samples, over their sum: a third of the triangles at its vertex that count; equal for samples that are no
/// vertices. 0: the sample lies on none that count.
[[nodiscard]] std::vector<double> area_weights(const sim::Scene& scene, Surfaces surfaces = Surfaces::without_mirrors);

/// The discs' areas over their sum.
[[nodiscard]] std::vector<double> weights_by_area(std::span<const sim::Disc> discs);

/// Sets the weights of samples that are on none of the named faces to 0, and those of the others to a sum of 1. Throws as
/// sim::samples_named.
void keep_named(std::vector<double>& weights, const sim::Mesh& mesh, std::span<const sim::Sample> samples,
                const sim::FaceNames& names, const std::stop_token& stop = {});

/// A random subset of the samples in question: those with a weight.
struct JudgedSamples {
  std::vector<sim::Sample> samples;
  std::vector<double> weights;      ///< by area, over their sum
  std::vector<std::size_t> places;  ///< among the scene's samples
  std::size_t population = 0;       ///< number of the samples in question

  /// The values at these samples, of values at all of the scene's samples.
  [[nodiscard]] std::vector<double> of_all(std::span<const double> values) const;
};

/// At most `most` (> 0) of the scene's samples, with these weights for all of them (none: by area): always the same ones of the same
/// number.
[[nodiscard]] JudgedSamples judged_samples(const sim::Scene& scene, std::size_t most,
                                           std::span<const double> weights = {});

}  // namespace detp::validate
