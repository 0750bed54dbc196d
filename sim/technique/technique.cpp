#include "technique.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "detp/sim/memory.hpp"
#include "detp/sim/stop_check.hpp"
#include "detp/sim/threads.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

/// Of pages not wholly used, small arrays, threads' stacks.
constexpr double small_bytes = 0x1p19;

double given_bytes(const Problem& problem) {
  return static_cast<double>(problem.rays.size()) * sizeof(Ray) +
         static_cast<double>(problem.discs.size()) * sizeof(Disc);
}

}  // namespace

void check_options(const RunOptions& options, const Problem& problem) {
  if (problem.discs.empty() || !(problem.slack > 0 && problem.slack < unbounded))
    throw std::invalid_argument("a problem needs discs and a slack > 0; make it by make_problem");
  require_count("number of threads", options.threads, 0, most_threads);
  if (options.totals != nullptr && !options.totals->empty() && options.totals->size() != problem.discs.size())
    throw std::invalid_argument(fmt::format("totals of {} discs cannot go on with {}; give those of the same discs",
                                            options.totals->size(), problem.discs.size()));
}

bool fits_memory(double bytes, const Problem& problem) { return given_bytes(problem) + bytes <= memory_budget(); }

void require_memory_for(std::string_view what, double bytes, const Problem& problem) {
  require_memory(fmt::format("{} rays, {} discs, and {}", problem.rays.size(), problem.discs.size(), what),
                 given_bytes(problem) + bytes);
}

void need_memory(std::string_view what, double bytes, const Problem& problem, Outcome& outcome) {
  bytes += small_bytes;
  require_memory_for(what, bytes, problem);
  outcome.bytes = std::max(outcome.bytes, bytes);
}

double found_bytes(const Problem& problem, const RunOptions& options) {
  constexpr double a_disc = sizeof(DiscTotals) + sizeof(std::uint64_t) + sizeof(double);
  return options.totals != nullptr ? 0 : a_disc * static_cast<double>(problem.discs.size());
}

void finish(const Totals& totals, std::span<const Disc> discs, Outcome& outcome) {
  outcome.hits.resize(discs.size());
  outcome.irradiance.resize(discs.size());
  for (std::size_t disc = 0; disc < discs.size(); ++disc) {
    outcome.hits[disc] = totals[disc].hits;
    outcome.irradiance[disc] = irradiance(totals[disc], discs[disc]);
  }
}

void keep_done_discs(Outcome& outcome) {
  outcome.progress = {0, outcome.done_discs.size(), "discs"};
  outcome.total_hits = 0;
  for (std::size_t disc = 0; disc < outcome.done_discs.size(); ++disc) {
    if (!outcome.done_discs[disc]) outcome.hits[disc] = 0;
    if (!outcome.done_discs[disc]) outcome.irradiance[disc] = 0;
    outcome.progress.done += outcome.done_discs[disc] ? 1 : 0;
    outcome.total_hits += outcome.hits[disc];
  }
  outcome.counts.hits = outcome.total_hits;
}

namespace {

void run_technique(const Problem& problem, const Candidate& candidate, const RunOptions& options, Outcome& outcome) {
  switch (candidate.technique) {
    case Technique::brute_force:
      run_brute_force(problem, options, outcome);
      break;
    case Technique::sphere_cache:
      run_sphere_cache(problem, std::get<SphereCacheParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::sphere_cache_published:
      run_sphere_cache_published(problem, std::get<SphereCacheParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::cell_spheres:
      run_cell_spheres(problem, std::get<CellSpheresParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::sphere_tree:
      run_sphere_tree(problem, std::get<SphereTreeParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::octree:
      run_octree(problem, std::get<OctreeParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::grid:
      run_grid(problem, std::get<GridParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::bsp:
      run_bsp(problem, std::get<BspParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::bvh:
      run_bvh(problem, std::get<BvhParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::photon_map:
      run_photon_map(problem, std::get<PhotonMapParameters>(candidate.parameters), options, outcome);
      break;
  }
}

}  // namespace

void give_nothing(const Problem& problem, const RunOptions& options, Outcome& outcome) {
  const Phases seconds = outcome.seconds;
  outcome = {};
  outcome.seconds = seconds;
  outcome.stopped = true;
  outcome.progress.of = problem.rays.size();
  if (options.totals == nullptr) finish(Totals(problem.discs.size()), problem.discs, outcome);
}

Outcome run(const Problem& problem, const Candidate& candidate, const RunOptions& options) {
  check(candidate);
  check_options(options, problem);
  Outcome outcome;
  try {
    StopCheck(options.stop, "beginning").now();
    run_technique(problem, candidate, options, outcome);
  } catch (const Stopped&) {  // before the search
    give_nothing(problem, options, outcome);
  }
  return outcome;
}

}  // namespace detp::sim
