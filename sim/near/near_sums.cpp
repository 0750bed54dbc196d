#include "near_sums.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/search/irradiance.hpp"
#include "each_disc.hpp"

namespace detp::sim {
namespace {

/// The sums of one disc in one band.
struct DiscSums {
  PhotonSums photons;
  double power = 0;
  double area = 0;
  double most_weight = 0;
};

/// Adds the landings of one disc, which are in the order of their rays.
void add(const Problem& problem, const Near& near, std::size_t band, bool errors, DiscSums& sums) {
  const double unit = std::ldexp(1.0, unit_exponent(problem.largest_power(band)));
  for (const Landed& one : near.landed) {
    const double power = one.weight * problem.power(one.ray, band);
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

/// Fills in the results of one band.
void finish(const Problem& problem, std::span<const DiscSums> sums, std::size_t band, bool errors,
            BandResults& results) {
  const double heaviest_power = heaviest(sums, problem.largest_power(band));
  const auto photons = static_cast<double>(problem.photons_to());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const DiscSums& one = sums[i];
    results.irradiance[i] = one.area > 0 ? one.power / one.area : 0;
    if (!errors) continue;
    const double weight = one.most_weight > 0 ? one.most_weight : 1;
    const ErrorSums sums_of_squares{one.photons.squares.x, one.photons.largest, one.photons.photons,
                                    unit_exponent(problem.largest_power(band))};
    const PowerError error = error_of_power(one.power, sums_of_squares, weight * heaviest_power, photons);
    results.standard_error[i] = one.area > 0 ? error.standard_error / one.area : unbounded;
    results.upper_bound[i] = one.area > 0 ? error.upper_bound / one.area : unbounded;
  }
}

}  // namespace

double near_bytes(const Problem& problem, const RunOptions& options) {
  const double errors = options.standard_error ? 2 * sizeof(double) : 0;
  const double of_band = sizeof(DiscSums) + sizeof(double) + errors;
  return static_cast<double>(problem.discs().size()) *
         (sizeof(std::uint64_t) + static_cast<double>(problem.bands()) * of_band);
}

void sum_near(const Problem& problem, const RunOptions& options,
              const std::function<void(std::uint32_t disc, Near& near)>& find, Outcome& outcome) {
  constexpr std::size_t discs_at_once = 128;
  const std::size_t discs = problem.discs().size();
  std::vector<std::vector<DiscSums>> sums(problem.bands());
  for (std::vector<DiscSums>& of_band : sums) of_band.resize(discs);
  resize_results(discs, options.standard_error, outcome, problem.bands());
  const std::vector<char> done = for_each_disc(options, discs, discs_at_once, [&] {
    return [&, near = Near{}](std::size_t i) mutable {
      near.clear();
      find(static_cast<std::uint32_t>(i), near);
      outcome.hits[i] = near.landed.size();
      std::ranges::sort(near.landed, {}, &Landed::ray);
      for (std::size_t band = 0; band < sums.size(); ++band)
        add(problem, near, band, options.standard_error, sums[band][i]);
      return true;
    };
  });
  for (std::size_t band = 0; band < sums.size(); ++band)
    finish(problem, sums[band], band, options.standard_error, outcome.band(band));
  outcome.progress = {problem.rays().size(), problem.rays().size()};
  add_up_discs(done, outcome);
}

}  // namespace detp::sim
