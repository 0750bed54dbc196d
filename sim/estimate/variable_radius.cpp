#include "variable_radius.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/search/index.hpp"
#include "detp/sim/search/irradiance.hpp"

namespace detp::sim {
namespace {

/// The two parts that find each other's radii, and the other photons.
enum class Part { first, second, rest };

Part part_of(std::uint64_t photon) {
  constexpr std::uint64_t seed = 1;
  const double chance = uniform4(seed, Stream::pilot, photon)[0];
  return chance < pilot_share ? Part::first : chance < 2 * pilot_share ? Part::second : Part::rest;
}

/// Some photons' rays with the photons' numbers; without what a search for pairs does not need.
struct SomePhotons {
  std::vector<Ray> rays;
  std::vector<std::uint64_t> photons;
  std::vector<double> further;  ///< powers

  void add(const Problem& problem, std::size_t ray) {
    rays.push_back(problem.rays()[ray]);
    photons.push_back(problem.photon(ray));
    const std::span<const double> powers = problem.further().of(ray);
    further.insert(further.end(), powers.begin(), powers.end());
  }
};

Outcome search(const Problem& problem, const SomePhotons& some, std::span<const Disc> discs, const Candidate& candidate,
               const RunOptions& options) {
  PathRays paths(some.rays);
  paths.photons = some.photons;
  paths.photon_count = problem.photons_to();
  paths.further = {some.further, problem.further().bands};
  return run(make_problem(paths, discs, problem.front_facing(), options.threads, options.stop), candidate, options);
}

/// Standard error and bound of a sum of independent parts, by the rules of irradiance.hpp. A part with one photon has the square of its
/// irradiance for a variance.
DiscResult sum_of(const DiscResult& a, const DiscResult& b) {
  DiscResult sum{a.hits + b.hits, a.irradiance + b.irradiance};
  const auto error = [](const DiscResult& one) {
    return one.standard_error < unbounded ? one.standard_error : one.irradiance;
  };
  const bool known = a.standard_error < unbounded || b.standard_error < unbounded || (a.hits > 0 && b.hits > 0);
  if (known) sum.standard_error = std::hypot(error(a), error(b));
  if (is_weak(a) || a.standard_error == 0)
    sum.upper_bound = a.upper_bound + b.upper_bound;
  else
    sum.upper_bound = sum.irradiance + (a.upper_bound - a.irradiance) / a.standard_error * sum.standard_error;
  return sum;
}

/// `rest` has most of the light.
void add(const Outcome& part, Outcome& rest) {
  add_block(part, rest);
  for (std::size_t i = 0; i < rest.hits.size(); ++i) {
    for (std::size_t band = 0; band < rest.bands(); ++band) {
      BandResults& to = rest.band(band);
      const DiscResult sum = sum_of(result_of(rest, i, band), result_of(part, i, band));
      to.irradiance[i] = sum.irradiance;
      if (to.standard_error.empty()) continue;
      to.standard_error[i] = sum.standard_error;
      to.upper_bound[i] = sum.upper_bound;
    }
    rest.hits[i] += part.hits[i];
  }
}

}  // namespace

std::uint64_t usual_hits(std::span<const std::uint64_t> hits) {
  std::vector<std::uint64_t> met;
  for (const std::uint64_t count : hits)
    if (count > 0) met.push_back(count);
  if (met.empty()) return 0;
  const auto middle = met.begin() + static_cast<std::ptrdiff_t>(met.size() / 2);
  std::nth_element(met.begin(), middle, met.end());
  return *middle;
}

std::vector<Disc> discs_of_pilot(std::span<const Disc> discs, std::span<const std::uint64_t> hits,
                                 std::uint64_t usual) {
  std::vector<Disc> changed(discs.begin(), discs.end());
  if (usual == 0) return changed;
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const double factor = std::sqrt((static_cast<double>(usual) + 1) / (static_cast<double>(hits[i]) + 1));
    changed[i].radius *= std::clamp(factor, 1 / most_growth, most_growth);
  }
  return changed;
}

Outcome estimate_with_variable_radius(const Problem& problem, const Candidate& candidate, const RunOptions& options) {
  const Stopwatch watch;
  SomePhotons first;
  SomePhotons second;
  SomePhotons others;  // all but the first
  for (std::size_t ray = 0; ray < problem.rays().size(); ++ray) {
    const Part part = part_of(problem.photon(ray));
    (part == Part::first ? first : others).add(problem, ray);
    if (part == Part::second) second.add(problem, ray);
  }
  if (first.rays.empty() || second.rays.empty())
    throw std::invalid_argument(
        "variable-radius needs more photons: some of them find the radii, the others the light");
  RunOptions quick = options;
  quick.count = quick.standard_error = false;
  quick.progress = {};
  const auto radii_by = [&](const SomePhotons& some) {
    const Outcome found = search(problem, some, problem.discs(), candidate, quick);
    return found.stopped ? std::vector<Disc>() : discs_of_pilot(problem.discs(), found.hits, usual_hits(found.hits));
  };
  const std::vector<Disc> by_first = radii_by(first);
  const std::vector<Disc> by_second = radii_by(second);
  if (by_first.empty() || by_second.empty()) return unsearched_outcome(problem, options);
  RunOptions silent = options;
  silent.progress = {};
  const Outcome part = search(problem, first, by_second, candidate, silent);
  const double prepare = watch.seconds();
  if (part.stopped) return unsearched_outcome(problem, options);
  Outcome outcome = search(problem, others, by_first, candidate, options);
  if (outcome.stopped) return outcome;
  const std::size_t rays = problem.rays().size();
  outcome.seconds.prepare += prepare - part.seconds.build - part.seconds.search;
  add(part, outcome);
  outcome.progress = {rays, rays};
  return outcome;
}

}  // namespace detp::sim
