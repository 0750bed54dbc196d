#include "choose_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/rays/ray_source.hpp"
#include "detp/sim/search/photon_blocks.hpp"
#include "detp/sim/search/soundness.hpp"

namespace detp::cli {
namespace {

constexpr int timed_parts = 5;
constexpr std::size_t rays_of_part = std::size_t{1} << 17;

/// Checks rays as a search does.
void check(std::span<const sim::Ray> rays, const std::stop_token& stop) {
  static_cast<void>(
      sim::check_rays(rays, {0, 0, 0}, std::numeric_limits<double>::max(), 0, sim::StopCheck(stop, "checking rays")));
}

/// Mean of several times, for so many rays.
template <class Make>
MakingTime timed(double rays, const Make& make) {
  static_cast<void>(make(0));  // the first has to fetch everything
  double sum = 0;
  double squares = 0;
  for (int part = 1; part <= timed_parts; ++part) {
    const sim::Stopwatch watch;
    const std::size_t made = make(part);
    const double each = watch.seconds() / static_cast<double>(made);
    sum += each;
    squares += each * each;
  }
  const double mean = sum / timed_parts;
  const double variance = std::max(0.0, squares / timed_parts - mean * mean) / (timed_parts - 1);
  return {rays * mean, rays * std::sqrt(variance)};
}

std::string bytes_text(double bytes) {
  return bytes >= 1e9 ? fmt::format("{:.3g} GB", bytes / 1e9) : fmt::format("{:.3g} MB", bytes / 1e6);
}

Json json_of(const model::SharedTime& time) {
  return {{"predicted_seconds", time.total()},
          {"count_seconds", time.count},
          {"make_seconds", time.make},
          {"build_seconds", time.build},
          {"search_seconds", time.search},
          {"collect_seconds", time.collect},
          {"memory", time.memory},
          {"traffic", time.traffic}};
}

}  // namespace

MakingTime making_time(const validate::Job& job, const std::stop_token& stop) {
  if (job.rays_from_file)
    throw std::invalid_argument("--ranks predicts rays that are made; give a scene or numbers, not --ray-file");
  return timed(job.given.rays, [&](int part) {
    const auto made = job.more_rays(std::uint64_t{rays_of_part} * static_cast<std::uint64_t>(part),
                                    static_cast<std::uint64_t>(part), rays_of_part, stop);
    check(made.rays, stop);
    return made.rays.size();
  });
}

MakingTime making_time(const Workload& workload, std::uint64_t seed, const std::stop_token& stop) {
  const sim::LinesOfField lines({{0, 0, 0}, workload.sphere_radius}, seed, rays_of_part * (timed_parts + 1));
  std::vector<sim::Ray> rays(rays_of_part);
  return timed(workload.rays, [&](int part) {
    lines.read(rays_of_part * static_cast<std::uint64_t>(part), rays, stop);
    check(rays, stop);
    return rays.size();
  });
}

RanksAnswer choose_ranks(const RanksOptions& options, const Workload& workload, double photons_per_ray,
                         bool photon_paths, double triangles, const Prediction& prediction, double search_error,
                         const MakingTime& making, const UnitCosts& costs) {
  constexpr double triangle_bytes = 200;  // with its vertices and the ray caster's tree
  const CostBreakdown& time = prediction.time;
  const double build = time.order + time.build;
  const double search_seconds = time.total() - build;
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
      .each_ray_seconds = search_seconds * model::share_of_each_ray(prediction, costs, workload.samples),
      .scene_bytes = triangles * triangle_bytes};
  RanksAnswer answer{.ranks = *options.ranks,
                     .network = {.bytes_per_second = options.bytes_per_second},
                     .memory_limit = sim::memory_budget(),
                     .rays = {},
                     .discs = {}};
  answer.rays = share_rays(search, answer.ranks, answer.network);
  answer.discs = share_discs(search, answer.ranks, answer.network);
  const bool rays_fit = answer.rays.memory <= answer.memory_limit;
  const bool discs_fit = answer.discs.memory <= answer.memory_limit;
  answer.by_rays = rays_fit == discs_fit ? answer.rays.total() <= answer.discs.total() : rays_fit;
  answer.fits = rays_fit || discs_fit;
  answer.alone = share_rays(search, 1, answer.network).total();
  const model::SharedTime& best = answer.best();
  const double of_search = search.search_seconds > 0 ? best.search / search.search_seconds : 0;
  const double of_making = making.seconds > 0 ? (best.count + best.make) / making.seconds : 0;
  answer.error = std::hypot(of_search * search_error, of_making * making.error);
  return answer;
}

Json to_json(const RanksAnswer& answer) {
  Json json{{"count", answer.ranks},
            {"share", answer.by_rays ? "rays" : "discs"},
            {"predicted_seconds", answer.best().total()},
            {"predicted_seconds_error", answer.error},
            {"alone_seconds", answer.alone},
            {"memory", answer.best().memory},
            {"memory_limit", answer.memory_limit},
            {"fits", answer.fits},
            {"traffic", answer.best().traffic},
            {"network_bytes_per_second", answer.network.bytes_per_second},
            {"network_latency", answer.network.latency}};
  json["shares"] = {{"rays", json_of(answer.rays)}, {"discs", json_of(answer.discs)}};
  return json;
}

std::string ranks_line(const RanksAnswer& answer) {
  return fmt::format(
      "ranks     {:.9g} processes share the {}: {:.3g} ± {:.1g} s with making the rays (one process {:.3g} s); {} on "
      "rank 0{}, "
      "which receives {}",
      answer.ranks, answer.by_rays ? "rays" : "discs", answer.best().total(), answer.error, answer.alone,
      bytes_text(answer.best().memory),
      answer.fits ? "" : fmt::format(", more than the {} that it may have", bytes_text(answer.memory_limit)),
      bytes_text(answer.best().traffic));
}

}  // namespace detp::cli
