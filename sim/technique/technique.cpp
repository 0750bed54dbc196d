#include "technique.hpp"

#include <algorithm>
#include <array>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"

namespace detp::sim {

// Each is defined in its own file.
Prepare prepare_brute_force, prepare_sphere_cache, prepare_sphere_cache_published, prepare_cell_spheres,
    prepare_sphere_tree, prepare_box_tree, prepare_octree, prepare_grid, prepare_bsp, prepare_bvh, prepare_ray_map,
    prepare_photon_map;

namespace {

constexpr std::array<TechniqueSearch, technique_records.size()> registry{{
    {Technique::brute_force, prepare_brute_force},
    {Technique::sphere_cache, prepare_sphere_cache},
    {Technique::sphere_cache_published, prepare_sphere_cache_published},
    {Technique::cell_spheres, prepare_cell_spheres},
    {Technique::sphere_tree, prepare_sphere_tree},
    {Technique::box_tree, prepare_box_tree},
    {Technique::octree, prepare_octree},
    {Technique::grid, prepare_grid},
    {Technique::bsp, prepare_bsp},
#ifdef DETP_WITHOUT_EMBREE
    {Technique::bvh, nullptr},  // no valid candidate
#else
    {Technique::bvh, prepare_bvh},
#endif
    {Technique::ray_map, prepare_ray_map},
    {Technique::photon_map, prepare_photon_map},
}};

}  // namespace

const TechniqueSearch& search_of(Technique technique) { return registry[static_cast<std::size_t>(technique)]; }

std::unique_ptr<Index> prepare(const Problem& problem, const Valid<Candidate>& candidate, const RunOptions& options) {
  const DefaultFloatingPoint mode;
  return search_of(candidate.technique).prepare(problem, candidate.parameters, options);
}

Outcome run(const Problem& problem, const Valid<Candidate>& candidate, const RunOptions& options) {
  check_options(options, problem);
  Stopwatch watch;
  std::unique_ptr<Index> index;
  try {
    StopCheck(options.stop, "beginning").now();
    index = prepare(problem, candidate, options);
  } catch (const Stopped&) {
    Outcome outcome = unsearched_outcome(problem, options);
    outcome.seconds.build = watch.lap();
    return outcome;
  }
  return run(problem, *index, options);
}

Outcome run(const Problem& problem, const Index& index, const RunOptions& options) {
  Outcome outcome = search(index, problem, options);
  const Built& built = index.built();
  outcome.seconds.order += built.seconds.order;
  outcome.seconds.build += built.seconds.build;
  outcome.bytes = std::max(outcome.bytes, built.bytes);
  if (options.count) outcome.counts += built.counts;
  return outcome;
}

}  // namespace detp::sim
