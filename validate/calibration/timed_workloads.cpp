#include "timed_workloads.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/sim/geometry/lebesgue.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/search/problem.hpp"

namespace detp::validate {
namespace {

constexpr double side = 1;

/// Those whose runs are short even with many discs or many rays.
std::vector<Candidate> candidates_of_large(const TimedWorkload& workload, std::size_t place) {
  const int leaf = workload.rays > workload.samples ? 8 : place % 2 == 0 ? 64 : 256;
  return {{Technique::brute_force, BruteForceParameters{}},
          {Technique::box_tree, BoxTreeParameters{8, leaf}},
          {Technique::box_tree, BoxTreeParameters{16, 2 * leaf}}};
}

}  // namespace

std::vector<TimedWorkload> timed_workloads() {
  std::vector<TimedWorkload> all;
  for (const std::size_t samples : {100UL, 1000UL, 10'000UL, 100'000UL})
    for (const std::size_t rays : {100UL, 1000UL, 10'000UL, 100'000UL})
      for (const double spacing : {0.1, 0.5, 2.0})  // disc radius over the distance between samples
        for (const auto body : {sim::Body::cube, sim::Body::cube_faces}) {
          const double root = body == sim::Body::cube ? 1.0 / 3 : 0.5;
          const double distance = side / std::pow(static_cast<double>(samples), root);
          const double radius = std::min(0.2 * side, spacing * distance);
          if (static_cast<double>(samples * rays) * radius * radius < 3e6) all.push_back({body, samples, rays, radius});
        }
  std::vector<TimedWorkload> first;
  std::vector<TimedWorkload> mixed;
  constexpr std::size_t stride = 29;  // has no common factor with the number of workloads
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TimedWorkload& one = all[i * stride % all.size()];
    const bool small = one.samples <= 1000 && one.rays <= 1000;
    (small && first.size() < least_workloads ? first : mixed).push_back(one);
  }
  const std::vector<TimedWorkload> large{
      {sim::Body::cube, 300'000, 100, 0.004},           {sim::Body::cube, 100, 1'000'000, 0.03},
      {sim::Body::cube_faces, 1'000'000, 1000, 0.0005}, {sim::Body::cube_faces, 1000, 300'000, 0.01},
      {sim::Body::cube_faces, 300'000, 10'000, 0.002},  {sim::Body::cube, 1000, 1'000'000, 0.01},
      {sim::Body::cube, 600'000, 100, 0.001},           {sim::Body::cube_faces, 10'000, 300'000, 0.01}};
  constexpr std::size_t apart = 2;
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    if (i % apart == 0 && i / apart < large.size()) first.push_back(large[i / apart]);
    first.push_back(mixed[i]);
  }
  return first;
}

std::vector<sim::Disc> discs_of(const TimedWorkload& workload, std::size_t place) {
  std::vector<sim::Disc> discs = sim::uniform_discs(workload.body, side, workload.samples, workload.radius, place + 1);
  if (place / 2 % 2 == 0) return discs;
  sim::Box box;
  for (const sim::Disc& disc : discs) box.include(disc.centre);
  std::sort(discs.begin(), discs.end(), [&](const sim::Disc& a, const sim::Disc& b) {
    return sim::lebesgue_code(a.centre, box) < sim::lebesgue_code(b.centre, box);
  });
  return discs;
}

std::vector<sim::Ray> rays_of(const TimedWorkload& workload, const std::vector<sim::Disc>& discs, std::size_t place) {
  const sim::Sphere enclosing = sim::enclosing_sphere(discs);
  std::vector<sim::Ray> rays = sim::LineField(enclosing, place + 1).lines(0, workload.rays);
  if (place / 4 % 2 == 0) return rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto random = sim::uniform4(place + 1, sim::Stream::structure, i);
    rays[i].origin += (2 * random[0] - 1) * enclosing.radius * rays[i].direction;
    rays[i].length = (0.1 + 0.4 * random[1]) * side;
  }
  return rays;
}

std::vector<Candidate> timed_candidates(const TimedWorkload& workload, std::size_t place) {
  if (is_large(workload)) return candidates_of_large(workload, place);
  const auto pick = [&](auto... values) {
    const std::array list{values...};
    return list[place % list.size()];
  };
  const auto samples = static_cast<double>(workload.samples);
  const int levels = std::max(1, static_cast<int>(std::lround(std::log2(samples) / 3)));
  const double outer = std::sqrt(0.75) * side + workload.radius;
  std::vector<Candidate> list{{Technique::brute_force, BruteForceParameters{}}};
  for (const double ratio : {pick(0.4, 0.5, 0.6), pick(0.65, 0.75, 0.55)}) {
    const std::int64_t most = model::sphere_count(Form::corrected, {ratio}, {workload.radius}, {outer});
    list.push_back(
        {Technique::sphere_cache, SphereCacheParameters{ratio, std::max<std::int64_t>(1, most - pick(0, 1, 2))}});
  }
  for (const int depth : {levels, std::max(1, levels - 1)})
    list.push_back({Technique::cell_spheres, CellSpheresParameters{depth}});
  for (const int leaf : {pick(2, 8), pick(16, 64)})
    list.push_back({Technique::sphere_tree, SphereTreeParameters{pick(4, 8, 16), leaf}});
  for (const int leaf : {pick(4, 8, 16), pick(32, 64), pick(128, 256)})
    list.push_back({Technique::box_tree, BoxTreeParameters{pick(4, 16, 8, 2), leaf}});
  for (const int depth : {levels + 1, std::max(1, levels - pick(0, 1)), std::max(0, levels - 2)})
    list.push_back({Technique::octree, OctreeParameters{depth}});
  const double cells = std::max(4.0, std::cbrt(samples));
  for (const double factor : {0.25, pick(0.5, 1.0), 2.0})
    list.push_back({Technique::grid, GridParameters{static_cast<int>(factor * cells)}});
  for (const Technique technique : {Technique::bsp, Technique::bvh, Technique::ray_map})
    list.push_back(default_candidate(technique));
  return list;
}

}  // namespace detp::validate
