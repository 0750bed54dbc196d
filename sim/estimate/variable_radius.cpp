#include "variable_radius.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/search/index.hpp"

namespace detp::sim {
namespace {

/// Rays, and photons counted from 0.
struct SomePhotons {
  PathRays paths;
  std::vector<std::uint64_t> photons;

  SomePhotons(const Problem& problem, std::size_t first, std::size_t end, std::uint64_t first_photon,
              std::uint64_t count)
      : paths(problem.paths()) {
    const std::size_t rays = end - first;
    paths.rays = paths.rays.subspan(first, rays);
    paths.landings = {};  // a search for pairs needs neither
    paths.triangles = {};
    if (!problem.numbered()) return;
    photons.reserve(rays);
    for (std::size_t ray = first; ray < end; ++ray) photons.push_back(problem.photon(ray) - first_photon);
    paths.photons = photons;
    paths.photon_count = count;
  }
};

}  // namespace

std::vector<Disc> discs_of_pilot(std::span<const Disc> discs, std::span<const std::uint64_t> hits) {
  std::vector<std::uint64_t> met;
  for (const std::uint64_t count : hits)
    if (count > 0) met.push_back(count);
  std::vector<Disc> changed(discs.begin(), discs.end());
  if (met.empty()) return changed;
  const auto middle = met.begin() + static_cast<std::ptrdiff_t>(met.size() / 2);
  std::nth_element(met.begin(), middle, met.end());
  const auto usual = static_cast<double>(*middle);
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const double factor = std::sqrt((usual + 1) / (static_cast<double>(hits[i]) + 1));
    changed[i].radius *= std::clamp(factor, 1 / most_growth, most_growth);
  }
  return changed;
}

Outcome estimate_with_variable_radius(const Problem& problem, const Candidate& candidate, const RunOptions& options) {
  const Stopwatch watch;
  const std::size_t rays = problem.rays().size();
  const std::uint64_t all = problem.photons_to();
  const auto pilot = static_cast<std::uint64_t>(std::ceil(pilot_share * static_cast<double>(all)));
  const std::size_t first =
      problem.numbered()
          ? static_cast<std::size_t>(std::ranges::lower_bound(problem.photons(), pilot) - problem.photons().begin())
          : std::min<std::size_t>(pilot, rays);
  if (first == 0 || first == rays)
    throw std::invalid_argument(
        "variable-radius needs more photons: a tenth of them find the radii, the others the light");
  RunOptions quick = options;
  quick.count = quick.standard_error = false;
  quick.progress = {};
  const SomePhotons some(problem, 0, first, 0, pilot);
  const Outcome found =
      run(make_problem(some.paths, problem.discs(), problem.front_facing(), options.threads, options.stop), candidate,
          quick);
  if (found.stopped) return unsearched_outcome(problem, options);
  const std::vector<Disc> discs = discs_of_pilot(problem.discs(), found.hits);
  const SomePhotons others(problem, first, rays, pilot, all - pilot);
  const Problem rest = make_problem(others.paths, discs, problem.front_facing(), options.threads, options.stop);
  const double prepare = watch.seconds();
  Outcome outcome = run(rest, candidate, options);
  outcome.seconds.prepare += prepare;
  const double scale = static_cast<double>(all) / static_cast<double>(all - pilot);
  for (std::vector<double>* results : {&outcome.irradiance, &outcome.standard_error, &outcome.upper_bound})
    for (double& one : *results) one *= scale;
  return outcome;
}

}  // namespace detp::sim
