#include "searcher.hpp"

#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "registry.hpp"

namespace detp::sim {

Problem searched_problem(std::span<const Disc> discs, std::optional<double> farthest, bool front_facing,
                         const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  constexpr double radii = 1000;
  if (!farthest) farthest = radii * enclosing_sphere(discs, stop).radius;
  return make_problem_without_rays(discs, *farthest, front_facing, stop);
}

Searcher::Searcher(std::span<const Disc> discs, const Candidate& candidate, std::optional<double> farthest,
                   bool front_facing, const RunOptions& options)
    : Searcher(std::vector<Disc>{}, discs, candidate, farthest, front_facing, options) {}

Searcher::Searcher(const DiscsView& discs, const Candidate& candidate, std::optional<double> farthest,
                   bool front_facing, const RunOptions& options)
    : Searcher(read_discs(discs), {}, candidate, farthest, front_facing, options) {}

Searcher::Searcher(std::vector<Disc> copies, std::span<const Disc> borrowed, const Candidate& candidate,
                   std::optional<double> farthest, bool front_facing, const RunOptions& options)
    : own_discs_(std::move(copies)),
      problem_(searched_problem(own_discs_.empty() ? borrowed : own_discs_, farthest, front_facing, options.stop)) {
  check_options(options, problem_);
  index_ = prepare(problem_, candidate, options);
}

const Outcome& Searcher::search(const PathRays& rays, SearchScratch& scratch, RunOptions options) const {
  const DefaultFloatingPoint mode;
  Stopwatch watch;
  Problem problem = problem_;
  set_rays(problem, rays, options.threads);
  const double prepare = watch.lap();
  scratch.memory.begin();
  options.memory = &scratch.memory;
  detp::sim::search(*index_, problem, options, scratch.outcome);
  scratch.outcome.seconds.prepare = prepare;
  return scratch.outcome;
}

const Outcome& Searcher::search(const RaysView& rays, SearchScratch& scratch, const RunOptions& options) const {
  Stopwatch watch;
  read_rays(rays, scratch.rays, options.threads);
  const double reading = watch.lap();
  search(PathRays{scratch.rays, rays.photons, rays.landings}, scratch, options);
  scratch.outcome.seconds.prepare += reading;
  return scratch.outcome;
}

}  // namespace detp::sim
