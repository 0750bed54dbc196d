#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "reference.hpp"

/// Where errors of estimates are taken.
namespace detp::validate {

/// Area around each of the scene's samples, over their sum: a third of the triangles at its vertex; equal for samples that are no
/// vertices.
[[nodiscard]] std::vector<double> area_weights(const sim::Scene& scene);

struct JudgedSamples {
  std::vector<sim::Sample> samples;
  std::vector<double> weights;      ///< by area, over their sum
  std::vector<std::size_t> places;  ///< among the scene's samples; empty: they are those of a reference

  /// The values at these samples, of values at all of the scene's samples. Only if there are `places`.
  [[nodiscard]] std::vector<double> of_all(std::span<const double> values) const;
};

/// The samples of the reference, if there is one; else at most `most` (> 0) of the scene's, one of every so many: neighbours in the array are
/// often neighbours in space.
[[nodiscard]] JudgedSamples judged_samples(const sim::Scene& scene, const Reference* reference, std::size_t most);

}  // namespace detp::validate
