#include "searcher.hpp"

#include <limits>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/search/soundness.hpp"
#include "streamed.hpp"
#include "successive_search.hpp"
#include "technique.hpp"

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

PathRays Searcher::read(const RaysView& rays, std::size_t first, std::size_t count, SearchScratch& scratch,
                        int threads) {
  scratch.rays.resize(count);
  read_rays(rays, first, scratch.rays, threads);
  read_further_powers(rays, first, count, scratch.further);
  PathRays some(scratch.rays);
  some.further = {scratch.further, rays.further_powers.size()};
  return some;
}

const Outcome& Searcher::search(const RaysView& rays, SearchScratch& scratch, const RunOptions& options) const {
  if (const std::size_t most = piece(options.engine); rays.count > most) {
    search_pieces(rays, most, scratch, options);
    return scratch.outcome;
  }
  Stopwatch watch;
  PathRays all = read(rays, 0, rays.count, scratch, options.threads);
  all.photons = rays.photons;  // checked by the search
  all.landings = rays.landings;
  const double reading = watch.lap();
  search(all, scratch, options);
  scratch.outcome.seconds.prepare += reading;
  return scratch.outcome;
}

std::size_t Searcher::piece(Engine engine) const {
  constexpr std::size_t rays = std::size_t{1} << 18;
  if (index_->sorts_rays()) return std::numeric_limits<std::size_t>::max();
  return engine == Engine::simd ? rays : default_block(problem_.discs().size());
}

void Searcher::search_pieces(const RaysView& rays, std::size_t piece, SearchScratch& scratch,
                             RunOptions options) const {
  const DefaultFloatingPoint mode;
  require_one_each("photon numbers", rays.photons.size(), rays.count);
  require_one_each("landings", rays.landings.size(), rays.count);
  options.memory = &scratch.memory;
  scratch.memory.begin();
  clear(scratch.outcome);
  SuccessiveSearch pieces(*index_, problem_, options, 0, rays.count,
                          static_cast<double>(piece * bytes_of_ray_in(1 + rays.further_powers.size())),
                          scratch.outcome);
  double reading = 0;
  while (pieces.next() < rays.count && !pieces.stopped()) {
    const std::size_t first = pieces.next();
    const std::size_t count = end_of_piece(rays, first, piece) - first;
    Stopwatch watch;
    PathRays part = read(rays, first, count, scratch, options.threads);
    reading += watch.lap();
    if (!rays.photons.empty()) part.photons = rays.photons.subspan(first, count);
    if (!rays.landings.empty()) part.landings = rays.landings.subspan(first, count);
    pieces.add(part);
  }
  pieces.finish();
  scratch.outcome.seconds.prepare += reading;
}

}  // namespace detp::sim
