#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "all_effects.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

/// Classes of radii whose squares have the same binary exponent. The radii below 1/64 of the largest are one class.
std::vector<RadiusClass> radius_classes(const EffectSample& sample) {
  struct Sums {
    double discs = 0;
    double squares = 0;
  };
  const double largest = sample.problem.radii().largest;
  const int highest = std::ilogb(largest * largest);
  constexpr int classes_apart = 12;
  const auto place_of = [&](double radius) {
    return static_cast<std::size_t>(std::min(highest - std::ilogb(radius * radius), classes_apart));
  };
  std::array<Sums, classes_apart + 1> sums;
  StopCheck check(sample.stop, "measuring the samples");
  for_each_checked(sample.problem.discs(), check, [&](const Disc& disc) {
    Sums& sum = sums[place_of(disc.radius)];
    sum.discs += 1;
    sum.squares += disc.radius * disc.radius;
  });
  const auto count = static_cast<double>(sample.problem.discs().size());
  std::vector<RadiusClass> classes;
  for (const Sums& sum : sums)
    if (sum.discs > 0) classes.push_back({std::sqrt(sum.squares / sum.discs), sum.discs / count});
  return classes;
}

Finding find_radii(const EffectSample& sample) {
  const DiscRadii& radii = sample.problem.radii();
  return {.value = radii.largest / radii.rms,
          .apply = [&sample](Workload& workload) { workload.radii = radius_classes(sample); }};
}

double radii_of_numbers(const Workload& workload) { return largest_radius(workload) / workload.disc_radius; }

}  // namespace

constinit const Effect mixed_radii{.name = "radius per disc",
                                   .evidence = "largest radius over the root mean square",
                                   .threshold = {Threshold::Side::above, 1.1, 0},
                                   .is_input = true,
                                   .find = find_radii,
                                   .of_numbers = radii_of_numbers};

}  // namespace detp::sim
