#include <cmath>

#include "hit_collector.hpp"
#include "ray_list.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

struct CachedSphere {
  Sphere sphere;
  RayList rays;
};

bool holds(const Sphere& sphere, const Disc& disc) {
  return glm::distance(disc.centre, sphere.centre) + disc.radius <= sphere.radius;
}

/// S₀ … S_k; the first `valid` of them were built, each from the one before.
template <bool counting>
class SphereCache {
 public:
  SphereCache(const Problem& problem, const SphereCacheParameters& parameters)
      : problem_(problem), spheres_(sphere_total(problem, parameters)), events_(spheres_.size() - 1) {
    spheres_[0].sphere = problem.enclosing;
    spheres_[0].rays = list_of(problem.rays);
    for (std::size_t i = 1; i < spheres_.size(); ++i)
      spheres_[i].sphere.radius = problem.enclosing.radius * std::pow(parameters.ratio, static_cast<double>(i));
  }

  /// Exact: the spheres that hold the disc, from the outermost inwards without a gap.
  std::size_t innermost_of_all_that_hold(const Disc& disc) const {
    std::size_t i = 0;
    while (i + 1 < valid_ && holds(spheres_[i + 1].sphere, disc)) ++i;
    return i;
  }

  /// The paper's: the innermost sphere that holds the disc, whether or not those around it do.
  std::size_t innermost_that_holds(const Disc& disc) const {
    std::size_t i = valid_ - 1;
    while (i > 0 && !holds(spheres_[i].sphere, disc)) --i;
    return i;
  }

  /// Rebuilds the spheres inside `from` around the disc, as long as they hold it; the rays of the innermost.
  const RayList& rebuild_inside(std::size_t from, const Disc& disc) {
    valid_ = from + 1;
    while (valid_ < spheres_.size() && disc.radius <= spheres_[valid_].sphere.radius) rebuild(valid_++, disc.centre);
    return spheres_[valid_ - 1].rays;
  }

  void report(Outcome& outcome, Tally<counting> tally) const {
    for (const SphereCounts& events : events_) {
      tally.add(&Counts<std::uint64_t>::sphere_tests, events.tests);
      tally.add(&Counts<std::uint64_t>::copies, events.listed);
      tally.add(&Counts<std::uint64_t>::rebuilds, events.rebuilds);
    }
    outcome.counts = tally.counts();
    if (counting) outcome.spheres = events_;
  }

 private:
  /// Spheres smaller than the smallest disc would never be built.
  static std::size_t sphere_total(const Problem& problem, const SphereCacheParameters& parameters) {
    double smallest = problem.enclosing.radius;
    for (const Disc& disc : problem.discs) smallest = std::min(smallest, disc.radius);
    std::size_t total = 1;
    while (total <= static_cast<std::size_t>(parameters.spheres) &&
           problem.enclosing.radius * std::pow(parameters.ratio, static_cast<double>(total)) >= smallest)
      ++total;
    return total;
  }

  void rebuild(std::size_t i, const glm::dvec3& centre) {
    const RayList& around = spheres_[i - 1].rays;
    auto& [sphere, rays] = spheres_[i];
    sphere.centre = centre;
    cull(around, sphere, problem_.slack, rays);
    if constexpr (counting) {
      ++events_[i - 1].rebuilds;
      events_[i - 1].tests += around.size();
      events_[i - 1].listed += rays.size();
    }
  }

  const Problem& problem_;
  std::vector<CachedSphere> spheres_;
  std::vector<SphereCounts> events_;
  std::size_t valid_ = 1;
};

enum class Walk { exact, published };

template <Walk walk, bool counting>
void search(const Problem& problem, const SphereCacheParameters& parameters, const RunOptions& options,
            Outcome& outcome) {
  Stopwatch watch;
  const std::vector<std::uint32_t> order = along_curve(problem.discs, parameters.order);
  outcome.seconds.order = watch.lap();
  HitCollector collector(problem, options);
  Tally<counting> tally;
  SphereCache<counting> cache(problem, parameters);
  for (const std::uint32_t d : order) {
    const Disc disc = problem.discs[d];
    const std::size_t serving =
        walk == Walk::exact ? cache.innermost_of_all_that_hold(disc) : cache.innermost_that_holds(disc);
    const RayList& rays = cache.rebuild_inside(serving, disc);
    test_disc(rays, disc, d, collector, tally);
    outcome.stopped = options.stop.stop_requested();
    if (outcome.stopped) break;
  }
  if (parameters.order != SampleOrder::none) tally.add(&Counts<std::uint64_t>::sorted, order.size());
  cache.report(outcome, tally);
  std::move(collector).give(outcome);
  outcome.seconds.search = watch.lap();
}

}  // namespace

void run_sphere_cache(const Problem& problem, const SphereCacheParameters& parameters, const RunOptions& options,
                      Outcome& outcome) {
  options.count ? search<Walk::exact, true>(problem, parameters, options, outcome)
                : search<Walk::exact, false>(problem, parameters, options, outcome);
}

void run_sphere_cache_published(const Problem& problem, const SphereCacheParameters& parameters,
                                const RunOptions& options, Outcome& outcome) {
  options.count ? search<Walk::published, true>(problem, parameters, options, outcome)
                : search<Walk::published, false>(problem, parameters, options, outcome);
}

}  // namespace detp::sim
