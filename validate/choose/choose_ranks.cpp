#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "choose.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/rays/ray_source.hpp"
#include "detp/sim/search/photon_sums.hpp"
#include "detp/sim/search/soundness.hpp"

namespace detp::validate {
namespace {

constexpr int timed_parts = 5;
constexpr std::size_t rays_of_part = std::size_t{1} << 17;

/// The time for making all rays and checking them, from some of them.
struct MakingTime {
  double seconds = 0;
  double error = 0;  ///< standard error
};

/// For so many rays; make(part) makes some of them.
template <class Make>
MakingTime timed(double rays, const std::stop_token& stop, const Make& make) {
  const auto make_and_check = [&](std::size_t part) {  // checked as a search does
    const std::span<const sim::Ray> made = make(part);
    static_cast<void>(
        sim::check_rays(made, {0, 0, 0}, std::numeric_limits<double>::max(), 0, sim::StopCheck(stop, "checking rays")));
    return static_cast<double>(made.size());
  };
  static_cast<void>(make_and_check(0));  // the first has to fetch everything
  double sum = 0;
  double squares = 0;
  for (int part = 1; part <= timed_parts; ++part) {
    const sim::Stopwatch watch;
    const double made = make_and_check(static_cast<std::size_t>(part));
    const double each = watch.seconds() / made;
    sum += each;
    squares += each * each;
  }
  const double mean = sum / timed_parts;
  const double variance = std::max(0.0, squares / timed_parts - mean * mean) / (timed_parts - 1);
  return {rays * mean, rays * std::sqrt(variance)};
}

/// Of further rays of the job; of lines, if numbers alone are known.
MakingTime making_time(const ChooseAnswer& answer, const std::stop_token& stop) {
  if (answer.job) {
    if (answer.job->rays_from_file)
      throw std::invalid_argument("--ranks predicts rays that are made; give a scene or numbers, not --ray-file");
    sim::TracedPaths made;
    return timed(answer.job->given.rays, stop, [&](std::size_t part) -> std::span<const sim::Ray> {
      made = answer.job->more_rays(rays_of_part * part, part, rays_of_part, stop);
      return made.rays;
    });
  }
  constexpr std::uint64_t seed = 1;  // any: only the time counts
  const sim::LinesOfField lines({{0, 0, 0}, answer.workload.sphere_radius}, seed, rays_of_part * (timed_parts + 1));
  std::vector<sim::Ray> rays(rays_of_part);
  return timed(answer.workload.rays, stop, [&](std::size_t part) -> std::span<const sim::Ray> {
    lines.read(rays_of_part * part, rays, stop);
    return rays;
  });
}

}  // namespace

RanksAnswer choose_ranks(const RanksRequest& request, const ChooseAnswer& answer, const std::stop_token& stop) {
  constexpr double triangle_bytes = 200;  // with its vertices and the ray caster's tree
  const MakingTime making = making_time(answer, stop);
  const Prediction& best = answer.choice.best();
  const Workload& workload = answer.workload;
  const bool photon_paths = answer.job && answer.job->field == sim::Field::photons;
  const double photons_per_ray =
      photon_paths ? static_cast<double>(answer.job->photon_count) / static_cast<double>(answer.job->rays.size()) : 1;
  const double build = best.time.order + best.time.build;
  const double search_seconds = best.seconds() - build;
  const auto discs = static_cast<std::size_t>(workload.samples);
  const model::SharedSearch search{
      .rays = workload.rays,
      .photons = std::max(1.0, workload.rays * photons_per_ray),
      .discs = workload.samples,
      .photons_in_block = static_cast<double>(sim::PhotonBlocks::for_discs(discs).first(1)),
      .photon_paths = photon_paths,
      .kept_bytes = sim::PhotonSource::most_kept_bytes(),
      .make_seconds = making.seconds,
      .build_seconds = build,
      .search_seconds = search_seconds,
      .each_ray_seconds =
          search_seconds * model::share_of_each_ray(best, answer.costs[best.candidate.technique], workload.samples),
      .scene_bytes = answer.job ? static_cast<double>(answer.job->triangles) * triangle_bytes : 0};
  RanksAnswer found{.ranks = request.ranks,
                    .network = {.bytes_per_second = request.bytes_per_second},
                    .memory_limit = sim::memory_budget(),
                    .rays = {},
                    .discs = {}};
  found.rays = share_rays(search, found.ranks, found.network);
  found.discs = share_discs(search, found.ranks, found.network);
  const bool rays_fit = found.rays.memory <= found.memory_limit;
  const bool discs_fit = found.discs.memory <= found.memory_limit;
  found.by_rays = rays_fit == discs_fit ? found.rays.total() <= found.discs.total() : rays_fit;
  found.fits = rays_fit || discs_fit;
  found.alone = share_rays(search, 1, found.network).total();
  const model::SharedTime& chosen = found.best();
  const double of_search = search.search_seconds > 0 ? chosen.search / search.search_seconds : 0;
  const double of_making = making.seconds > 0 ? (chosen.count + chosen.make) / making.seconds : 0;
  found.error = std::hypot(of_search * answer.error(), of_making * making.error);
  return found;
}

}  // namespace detp::validate
