#include <algorithm>
#include <cmath>

#include "all_effects.hpp"
#include "sample_dimension.hpp"

namespace detp::sim {
namespace {

Finding find_surfaces(const EffectSample& sample) {
  const SampleDimension& dimension = sample.dimension();
  return {.value = dimension.value,
          .standard_error = dimension.standard_error,
          .apply = [dimension = dimension.value, surface = sample.surface](Workload& workload) {
            workload.dimension = dimension;
            workload.sample_distance = surface.edge_length;
            workload.sample_extent = extent_on_surfaces(workload, surface.area);
          }};
}

double surfaces_of_numbers(const Workload& workload) { return workload.dimension; }

}  // namespace

double extent_on_surfaces(Workload samples, double area) {
  if (!(area > 0)) return sample_extent(samples);
  const double weight = std::clamp(samples.dimension - 2, 0.0, 1.0);
  samples.dimension = 3;
  samples.sample_extent = 0;
  return std::pow(sample_extent(samples), weight) * std::pow(area, 1 - weight);
}

constinit const Effect surface_samples{.name = "surface samples",
                                       .evidence = "dimension D of the samples, by box counting",
                                       .threshold = {Threshold::Side::below, 2.9, 0},
                                       .find = find_surfaces,
                                       .of_numbers = surfaces_of_numbers};

}  // namespace detp::sim
