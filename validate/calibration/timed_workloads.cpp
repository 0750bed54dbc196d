#include "timed_workloads.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/curve.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"

namespace detp::validate {
namespace {

/// 0: not known.
double seconds_of_byte() {
  constexpr std::size_t bytes = std::size_t{8} << 20;  // of the size of a search's arrays
  constexpr int tries = 5;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < tries; ++i) {
    void* const mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) return 0;
#ifdef MADV_HUGEPAGE
    madvise(mapped, bytes, MADV_HUGEPAGE);
#endif
    auto* const first = static_cast<volatile unsigned char*>(mapped);
    const sim::ProcessorStopwatch watch;
    for (std::size_t at = 0; at < bytes; at += page) first[at] = 1;
    least = std::min(least, watch.seconds() / static_cast<double>(bytes));
    munmap(mapped, bytes);
  }
  return least;
}

constexpr double cube_side = 1;

bool is_clustered(std::size_t place) { return place % 3 == 2; }
bool has_pieces(std::size_t place) { return place % 8 == 4 || place % 8 == 5; }
bool has_paths(std::size_t place) { return place % 8 == 6 || place % 8 == 7; }

/// Those whose runs are short even with many discs or many rays.
std::vector<Candidate> candidates_of_large(const TimedWorkload& workload, std::size_t place) {
  const int leaf = workload.rays > workload.samples ? 8 : place % 2 == 0 ? 64 : 256;
  std::vector<Candidate> list{{Technique::box_tree, BoxTreeParameters{8, leaf}},
                              {Technique::box_tree, BoxTreeParameters{16, 2 * leaf}}};
  const bool many_both = static_cast<double>(workload.samples) * static_cast<double>(workload.rays) > 3e9;
  list.push_back(many_both ? Candidate{Technique::box_tree, BoxTreeParameters{4, leaf}}
                           : Candidate{Technique::brute_force, BruteForceParameters{}});
  return list;
}

/// Moves the samples of each of some parts of space towards a centre, so that they lie in clusters of different density, as
/// the vertices of most meshes do.
void gather(std::vector<sim::Disc>& discs, std::size_t place) {
  constexpr std::uint64_t clusters = 24;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const auto cluster =
        static_cast<std::uint64_t>(clusters * sim::uniform4(place + 1, sim::Stream::structure, i, 1)[0]);
    const auto centre = sim::uniform4(place + 1, sim::Stream::structure, cluster, 2);
    const double size = 0.05 * std::pow(10.0, centre[3]);  // of the part of space that the cluster fills
    discs[i].centre = cube_side * glm::dvec3(centre[0], centre[1], centre[2]) + size * discs[i].centre;
  }
}

/// From one sample to another and a little further, as the pieces of a photon's path from surface to surface.
std::vector<sim::Ray> rays_between(const std::vector<sim::Disc>& discs, std::size_t count, std::size_t place) {
  std::vector<sim::Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto random = sim::uniform4(place + 1, sim::Stream::structure, i);
    const auto sample = [&](double uniform) {
      return discs[std::min(discs.size() - 1, static_cast<std::size_t>(uniform * static_cast<double>(discs.size())))]
          .centre;
    };
    const glm::dvec3 from = sample(random[0]);
    const glm::dvec3 way = sample(random[1]) - from + 1e-3 * cube_side * glm::dvec3(random[2], random[3], 0.5);
    rays[i].origin = from + 1e-5 * way;
    rays[i].direction = glm::normalize(way);
    rays[i].length = 1.0001 * glm::length(way);
  }
  return rays;
}

}  // namespace

std::vector<TimedWorkload> timed_workloads() {
  std::vector<TimedWorkload> all;
  for (const std::size_t samples : {100UL, 1000UL, 10'000UL, 100'000UL})
    for (const std::size_t rays : {100UL, 1000UL, 10'000UL, 100'000UL})
      for (const double spacing : {0.1, 0.5, 2.0})  // disc radius over the distance between samples
        for (const auto body : {sim::Body::cube, sim::Body::cube_faces}) {
          const double root = body == sim::Body::cube ? 1.0 / 3 : 0.5;
          const double distance = cube_side / std::pow(static_cast<double>(samples), root);
          const double radius = std::min(0.2 * cube_side, spacing * distance);
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
  const std::vector<TimedWorkload> large{{sim::Body::cube_faces, 1000, 300'000, 0.01},
                                         {sim::Body::cube, 300'000, 100, 0.004},
                                         {sim::Body::cube_faces, 100'000, 1'000'000, 0.0016},
                                         {sim::Body::cube_faces, 300'000, 10'000, 0.002},
                                         {sim::Body::cube, 1000, 1'000'000, 0.01},
                                         {sim::Body::cube_faces, 1'000'000, 1000, 0.0005},
                                         {sim::Body::cube_faces, 20'000, 600'000, 0.0035},
                                         {sim::Body::cube, 100, 1'000'000, 0.03},
                                         {sim::Body::cube_faces, 300'000, 1'000'000, 0.0009},
                                         {sim::Body::cube, 600'000, 100, 0.001},
                                         {sim::Body::cube_faces, 10'000, 300'000, 0.01}};
  constexpr std::size_t apart = 3;
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    if (i % apart == 0 && i / apart < large.size()) first.push_back(large[i / apart]);
    first.push_back(mixed[i]);
  }
  return first;
}

std::vector<sim::Disc> discs_of(const TimedWorkload& workload, std::size_t place) {
  std::vector<sim::Disc> discs =
      sim::uniform_discs(workload.body, cube_side, workload.samples, workload.radius, place + 1);
  if (is_clustered(place)) gather(discs, place);
  if (place / 2 % 2 == 0) return discs;
  sim::Box box;
  for (const sim::Disc& disc : discs) box.include(disc.centre);
  std::sort(discs.begin(), discs.end(), [&](const sim::Disc& a, const sim::Disc& b) {
    return sim::lebesgue_code(a.centre, box) < sim::lebesgue_code(b.centre, box);
  });
  return discs;
}

std::vector<sim::Ray> rays_of(const TimedWorkload& workload, const std::vector<sim::Disc>& discs, std::size_t place) {
  if (has_paths(place)) return rays_between(discs, workload.rays, place);
  const sim::Sphere enclosing = sim::enclosing_sphere(discs);
  std::vector<sim::Ray> rays = sim::LineField(enclosing, place + 1).lines(0, workload.rays);
  if (!has_pieces(place)) return rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto random = sim::uniform4(place + 1, sim::Stream::structure, i);
    rays[i].origin += (2 * random[0] - 1) * enclosing.radius * rays[i].direction;
    rays[i].length = (0.1 + 0.4 * random[1]) * cube_side;
  }
  return rays;
}

TimedScene::TimedScene(const TimedWorkload& workload, std::size_t number)
    : place(number), discs(discs_of(workload, number)), rays(rays_of(workload, discs, number)) {
  constexpr int tries = 3;
  for (int i = 0; i < tries; ++i) {
    sim::Stopwatch watch;
    sim::Problem made = sim::make_problem_without_rays(discs, problem.farthest());
    checking_discs = std::min(checking_discs, watch.lap());
    sim::set_rays(made, rays);
    checking_rays = std::min(checking_rays, watch.lap());
  }
}

std::vector<Candidate> timed_candidates(const TimedWorkload& workload, std::size_t place) {
  if (is_large(workload)) return candidates_of_large(workload, place);
  const auto pick = [&](auto... values) {
    const std::array list{values...};
    return list[place % list.size()];
  };
  const auto samples = static_cast<double>(workload.samples);
  const int levels = std::max(1, static_cast<int>(std::lround(std::log2(samples) / 3)));
  const double outer = std::sqrt(0.75) * cube_side + workload.radius;
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
    if (record_of(technique).built) list.push_back(default_candidate(technique));
  return list;
}

void set_touch_cost(Calibration& calibration) {
  const double seconds = seconds_of_byte();
  if (!(seconds > 0)) return;
  for (const Engine engine : {Engine::simd, Engine::plain})
    for (UnitCosts& costs : calibration.of(engine).of_technique) costs.touch = seconds;
}

}  // namespace detp::validate
