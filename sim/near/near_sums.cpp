#include "near_sums.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/search/irradiance.hpp"
#include "each_disc.hpp"

namespace detp::sim {
namespace {

/// The sums of one disc.
struct DiscSums {
  PhotonSums photons;
  double power = 0;
  double area = 0;
  double most_weight = 0;
};

/// Adds the landings of one disc, which are brought into the order of their rays.
void add(const Problem& problem, Near& near, bool errors, DiscSums& sums) {
  const double unit = std::ldexp(1.0, unit_exponent(problem.largest_power()));
  std::ranges::sort(near.landed, {}, &Landed::ray);
  for (const Landed& one : near.landed) {
    const double power = one.weight * problem.rays()[one.ray].power;
    sums.power += power;
    sums.most_weight = std::max(sums.most_weight, one.weight);
    if (errors) sums.photons.add(problem.photon(one.ray), 0, power, unit);
  }
  sums.photons.close(unit);
  sums.area = near.area;
}

/// Largest power of one photon at any disc, whatever the discs' weights.
double heaviest(std::span<const DiscSums> all, double largest_power) {
  for (const DiscSums& one : all)
    if (one.most_weight > 0) largest_power = std::max(largest_power, one.photons.largest / one.most_weight);
  return largest_power;
}

}  // namespace

double near_bytes(const Problem& problem, const RunOptions& options) {
  constexpr double results = sizeof(std::uint64_t) + sizeof(double);
  const double errors = options.standard_error ? 2 * sizeof(double) : 0;
  return static_cast<double>(problem.discs().size()) * (sizeof(DiscSums) + results + errors);
}

void sum_near(const Problem& problem, const RunOptions& options,
              const std::function<void(std::uint32_t disc, Near& near)>& find, Outcome& outcome) {
  constexpr std::size_t discs_at_once = 128;
  const std::size_t discs = problem.discs().size();
  std::vector<DiscSums> sums(discs);
  resize_results(discs, options.standard_error, outcome);
  const std::vector<char> done = for_each_disc(options, discs, discs_at_once, [&] {
    return [&, near = Near{}](std::size_t i) mutable {
      near.clear();
      find(static_cast<std::uint32_t>(i), near);
      outcome.hits[i] = near.landed.size();
      add(problem, near, options.standard_error, sums[i]);
      return true;
    };
  });
  const double heaviest_power = heaviest(sums, problem.largest_power());
  const auto photons = static_cast<double>(problem.photons_to());
  for (std::size_t i = 0; i < discs; ++i) {
    const DiscSums& one = sums[i];
    outcome.irradiance[i] = one.area > 0 ? one.power / one.area : 0;
    if (!options.standard_error) continue;
    const double weight = one.most_weight > 0 ? one.most_weight : 1;
    const ErrorSums sums_of_squares{one.photons.squares.x, one.photons.largest, one.photons.photons,
                                    unit_exponent(problem.largest_power())};
    const PowerError error = error_of_power(one.power, sums_of_squares, weight * heaviest_power, photons);
    outcome.standard_error[i] = one.area > 0 ? error.standard_error / one.area : unbounded;
    outcome.upper_bound[i] = one.area > 0 ? error.upper_bound / one.area : unbounded;
  }
  outcome.progress = {problem.rays().size(), problem.rays().size()};
  add_up_discs(done, outcome);
}

}  // namespace detp::sim
