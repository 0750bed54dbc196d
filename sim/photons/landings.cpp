#include "landings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/threads.hpp"
#include "photon_walk.hpp"

namespace detp::sim {
namespace {

/// Lengths are those of the scene.
class Surface {
 public:
  Surface(const RayCaster& caster, const Box& box)
      : caster_(caster), diagonal_(glm::length(box.size())), near_(surface_tolerance * diagonal_) {}

  [[nodiscard]] double diagonal() const { return diagonal_; }
  [[nodiscard]] double near() const { return near_; }

  struct Crossing {
    double distance;
    std::uint32_t triangle;
  };

  /// The first one from a distance on.
  [[nodiscard]] std::optional<Crossing> first(const glm::dvec3& origin, const glm::dvec3& direction, double from,
                                              double to, std::optional<std::uint32_t> start = {}) const {
    const double scale = caster_.scale();
    const auto met =
        caster_.first_intersection(caster_.to_caster(origin + from * direction), direction, start, (to - from) / scale);
    if (!met) return std::nullopt;
    return Crossing{from + met->distance * scale, met->triangle};
  }

  /// To the first one; unbounded if there is none.
  [[nodiscard]] double distance(const glm::dvec3& origin, const glm::dvec3& direction, double to,
                                std::optional<std::uint32_t> start) const {
    const auto met = first(origin, direction, 0, to, start);
    return met ? met->distance : unbounded;
  }

  /// The nearest one to a distance.
  [[nodiscard]] std::optional<Crossing> nearest(const glm::dvec3& origin, const glm::dvec3& direction,
                                                double at) const {
    constexpr int most = 16;
    std::optional<Crossing> best;
    std::optional<std::uint32_t> start;
    double from = at - near_;
    for (int i = 0; i < most; ++i) {
      const auto next = first(origin, direction, from, at + near_, start);
      if (!next || next->distance > at + near_) break;
      if (!best || std::abs(next->distance - at) < std::abs(best->distance - at)) best = next;
      start = next->triangle;
      from = next->distance;
    }
    return best;
  }

 private:
  const RayCaster& caster_;
  double diagonal_;
  double near_;
};

/// Calls work(ray, counts) for each ray on several threads, and adds up the counts.
template <class Work>
LandingCounts for_each_ray(std::size_t rays, int threads, const std::stop_token& stop, const Work& work) {
  LandingCounts sum;
  std::mutex one_at_a_time;
  on_threads(thread_count(threads), [&] {
    sim::parallel_for(ParallelRange(0, rays, 4096), [&](const ParallelRange& part) {
      LandingCounts counts;
      for (std::size_t ray = part.begin(); ray < part.end() && !stop.stop_requested(); ++ray) work(ray, counts);
      const std::lock_guard lock(one_at_a_time);
      sum.on_surface += counts.on_surface;
      sum.crossing += counts.crossing;
      sum.elsewhere += counts.elsewhere;
      sum.nowhere += counts.nowhere;
      sum.without_end += counts.without_end;
    });
  });
  if (stop.stop_requested()) throw Stopped("stopped while looking for the surfaces on which photons landed");
  return sum;
}

}  // namespace

LandingCounts land(Paths& paths, bool given, const RayCaster& caster, const Box& box, int threads,
                   const std::stop_token& stop) {
  const Surface surface(caster, box);
  paths.triangles.assign(paths.rays.size(), no_triangle);
  if (!given) paths.landings.assign(paths.rays.size(), unbounded);
  return for_each_ray(paths.rays.size(), threads, stop, [&](std::size_t i, LandingCounts& counts) {
    const Ray& ray = paths.rays[i];
    const double at = given ? paths.landings[i] : ray.length;
    if (at == unbounded) {
      ++(given ? counts.nowhere : counts.without_end);
      return;
    }
    auto met = surface.nearest(ray.origin, ray.direction, at);
    if (!met && !given) {
      met = surface.first(ray.origin, ray.direction, 0, ray.length);
      if (met) ++counts.crossing;
    }
    if (!met) {
      ++counts.elsewhere;
      return;
    }
    ++counts.on_surface;
    paths.triangles[i] = met->triangle;
    if (!given) paths.landings[i] = met->distance;
  });
}

LandingCounts make_pieces(Paths& paths, const RayCaster& caster, const Box& box, double overshoot, int threads,
                          const std::stop_token& stop) {
  if (std::ranges::any_of(paths.rays, [](const Ray& ray) { return !ray.is_line(); }))
    throw std::invalid_argument(
        "photons that have landed have a place and a direction; pieces of their paths are found in the scene: leave "
        "out length");
  const Surface surface(caster, box);
  const double gap = PhotonWalk::gap_share * surface.diagonal();
  paths.triangles.assign(paths.rays.size(), no_triangle);
  paths.landings.assign(paths.rays.size(), unbounded);
  return for_each_ray(paths.rays.size(), threads, stop, [&](std::size_t i, LandingCounts& counts) {
    Ray& ray = paths.rays[i];
    const glm::dvec3 place = ray.origin;
    const auto met = surface.nearest(place, ray.direction, 0);
    const double at = met ? met->distance : 0;
    if (met) {
      ++counts.on_surface;
      paths.triangles[i] = met->triangle;
    } else {
      ++counts.elsewhere;
    }
    // Backwards to the surface from which the photon came; around the box there is none within twice its diagonal.
    const double out = 2 * surface.diagonal();
    const auto start = met ? std::optional(met->triangle) : std::nullopt;
    const double before = surface.distance(place + at * ray.direction, -ray.direction, out, start);
    const double length = before == unbounded ? out : std::max(before - gap, 0.5 * before);
    double beyond = gap;
    if (overshoot > gap) {
      const double next = surface.distance(place + at * ray.direction, ray.direction, overshoot + gap, start);
      beyond = next == unbounded        ? std::min(overshoot, out)
               : overshoot == unbounded ? next + gap
                                        : std::min(overshoot, std::max(next - gap, 0.5 * next));
    }
    ray.origin = place + (at - length) * ray.direction;
    ray.length = length + beyond;
    paths.landings[i] = length;
  });
}

std::string landing_notice(const LandingCounts& counts) {
  std::string text;
  const auto add = [&](std::uint64_t rays, const char* what) {
    if (rays > 0) text += fmt::format("{}{} of {} rays {}", text.empty() ? "" : "; ", rays, counts.all(), what);
  };
  add(counts.elsewhere, "land where the scene has no surface: their photons are on no face");
  add(counts.without_end, "have no end: their photons land nowhere");
  add(counts.crossing, "end beyond the surface: they land where they first cross it");
  return text;
}

}  // namespace detp::sim
