#include <doctest/doctest.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/attempts.hpp"
#include "support/machine.hpp"

using namespace detp;
using namespace detp::sim;
using support::MemoryLimit;

// Compares predicted memory with the peak that the system reports for the process. Each run has a process of its own,
// so that it cannot reuse another run's heap. Arrays of 128 KiB or more return to the system when they are freed, so
// the peak does not include free memory that the heap keeps.

namespace {

constexpr double mebi = 0x1p20;

/// The number in a line of /proc/self/status, such as "VmHWM" (kB) or "Threads".
double status(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(name + ":")) return std::stod(line.substr(name.size() + 1));
  return 0;
}

/// Resets the peak; false if the system does not allow it.
bool reset_peak_memory() {
  std::ofstream file("/proc/self/clear_refs");
  file << 5;
  file.flush();
  return file.good();
}

struct DiscsAndRays {
  std::vector<Disc> discs;
  std::vector<Ray> rays;
  std::vector<double> further = {};  ///< powers in further bands
};

DiscsAndRays lines_through(std::vector<Disc> discs, std::size_t rays) {
  DiscsAndRays given{std::move(discs), {}};
  given.rays = LineField(enclosing_sphere(given.discs), 2).lines(0, rays);
  return given;
}

/// Cuts the lines to segments with different powers.
DiscsAndRays cut(DiscsAndRays given, double length) {
  for (std::size_t i = 0; i < given.rays.size(); ++i) {
    given.rays[i].length = length;
    given.rays[i].power = 1.0 + static_cast<double>(i % 2);
  }
  return given;
}

DiscsAndRays lines() { return lines_through(uniform_discs(Body::cube, 2, 150'000, 0.01, 1), 100'000); }

DiscsAndRays segments() { return cut(lines(), 0.3); }

/// In nine bands.
DiscsAndRays lines_in_bands() {
  DiscsAndRays given = lines();
  for (std::size_t i = 0; i < 8 * given.rays.size(); ++i) given.further.push_back(1.0 + static_cast<double>(i % 3));
  return given;
}

/// For techniques whose memory does not depend on the number of rays.
DiscsAndRays fewer_lines() { return lines_through(uniform_discs(Body::cube, 2, 150'000, 0.01, 1), 20'000); }

/// Discs in 27 clusters, one in each of 3³ cells of the space. A cluster fills 1/64 of its cell's volume.
DiscsAndRays few_rays_on_clusters() {
  DiscsAndRays given{uniform_discs(Body::cube, 2, 200'000, 0.002, 3), {}};
  for (Disc& disc : given.discs)
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::floor((disc.centre[axis] + 1) * 1.5);
      const double middle = (cell + 0.5) / 1.5 - 1;
      disc.centre[axis] = middle + 0.25 * (disc.centre[axis] - middle);
    }
  return lines_through(std::move(given.discs), 3'000);
}

DiscsAndRays many_rays_on_few_discs() {
  return lines_through(uniform_discs(Body::cube_faces, 2, 20'000, 0.01, 4), 300'000);
}

DiscsAndRays many_segments() { return cut(many_rays_on_few_discs(), 1.5); }

DiscsAndRays few_lines() { return lines_through(uniform_discs(Body::cube, 2, 4'000, 0.02, 5), 100'000); }

/// Threads without a core of their own may have nothing to do, and take no memory.
const int two_threads = std::min(2, thread_count(0));

struct Case {
  Candidate candidate;
  DiscsAndRays (*make)();
  const char* given;
  RunOptions options = {.count = false, .threads = two_threads};
};

struct Measured {
  double predicted = 0;
  double peak = 0;
};

/// Runs the candidate once, so that what a first call does (starting threads, loading code) is not measured.
void warm_up(const Candidate& candidate, const RunOptions& options) {
  DiscsAndRays given = lines_through(uniform_discs(Body::cube, 2, 500, 0.02, 6), 500);
  for (Ray& ray : given.rays) ray.length = 1;
  (void)run(make_problem(given.rays, given.discs), candidate, options);
}

Measured measure(const Case& each) {
  warm_up(each.candidate, each.options);
  const DiscsAndRays given = each.make();
  PathRays rays(given.rays);
  rays.further = {given.further, given.further.size() / given.rays.size()};
  const Problem problem = make_problem(rays, given.discs);
  set_memory_limit(1e15);  // what is freed is returned at once (page_pool.hpp)
  malloc_trim(0);
  reset_peak_memory();
  const double before = status("VmRSS");
  const Outcome outcome = run(problem, each.candidate, each.options);
  return {outcome.bytes, 1024 * (status("VmHWM") - before)};
}

/// Measures the memory of a run in a process of its own.
Measured measure_apart(const Case& each) {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    Measured measured;
    try {
      measured = measure(each);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    const bool sent = write(ends[1], &measured, sizeof measured) == sizeof measured;
    _exit(sent ? 0 : 1);
  }
  Measured measured;
  close(ends[1]);
  const bool received = read(ends[0], &measured, sizeof measured) == sizeof measured;
  close(ends[0]);
  int end = 0;
  waitpid(child, &end, 0);
  REQUIRE(received);
  REQUIRE(end == 0);
  return measured;
}

std::vector<Case> cases() {
  const std::vector<Candidate> all =
      support::built({{Technique::brute_force, {}},
                      {Technique::sphere_cache, SphereCacheParameters{0.65, 8}},
                      {Technique::sphere_cache, SphereCacheParameters{0.9, 40}},
                      {Technique::cell_spheres, CellSpheresParameters{5}},
                      {Technique::box_tree, BoxTreeParameters{4, 16}},
                      {Technique::box_tree, BoxTreeParameters{2, 1}},
                      {Technique::box_tree, BoxTreeParameters{4, 64}},
                      {Technique::sphere_tree, SphereTreeParameters{8, 4}},
                      {Technique::octree, OctreeParameters{5}},
                      {Technique::octree, OctreeParameters{6, Traversal::neighbour_links}},
                      {Technique::grid, GridParameters{60}},
                      {Technique::grid, GridParameters{150}},
                      {Technique::bsp, BspParameters{}},
                      {Technique::bvh, BvhParameters{BuildQuality::low}},
                      {Technique::bvh, BvhParameters{BuildQuality::medium}}});
  RunOptions pairs{.count = false, .pairs = true, .threads = two_threads};
  RunOptions errors{.count = false, .standard_error = true, .threads = two_threads};
  RunOptions plain{.count = false, .engine = Engine::plain, .threads = two_threads};
  std::vector<Case> list;
  for (const Candidate& candidate : all) {
    const bool brute = candidate.technique == Technique::brute_force;
    const bool streams = candidate.technique < Technique::octree;
    list.push_back({candidate, few_rays_on_clusters, "few rays on clusters"});
    if (!streams) {  // rays and engine make no difference for them
      list.push_back({candidate, fewer_lines, "lines"});
      list.push_back({candidate, fewer_lines, "pairs", pairs});
      continue;
    }
    list.push_back({candidate, brute ? few_rays_on_clusters : lines, "pairs", pairs});
    if (brute) continue;
    list.push_back({candidate, lines, "lines"});
    list.push_back({candidate, many_rays_on_few_discs, "many rays on few discs", {.count = false, .threads = 1}});
    list.push_back({candidate, segments, "segments"});
    list.push_back({candidate, few_rays_on_clusters, "few rays on clusters, plain", plain});
    list.push_back({candidate, few_lines, "few lines, plain", plain});
  }
  list.push_back({{Technique::box_tree, BoxTreeParameters{4, 16}}, segments, "standard errors", errors});
  for (const RunOptions& options : {errors, RunOptions{.count = false, .threads = 1}})
    list.push_back({{Technique::box_tree, BoxTreeParameters{4, 16}}, lines_in_bands, "nine bands", options});
  list.push_back({{Technique::photon_map, PhotonMapParameters{}}, many_segments, "many segments"});
  list.push_back({{Technique::photon_map, PhotonMapParameters{}}, many_segments, "pairs", pairs});
  return list;
}

}  // namespace

TEST_SUITE("memory") {
  TEST_CASE("no technique uses more memory than predicted, or much less") {
    if (support::sanitized || !reset_peak_memory() || status("Threads") > 1) {
      MESSAGE("skipped: the peak cannot be measured here; run this suite alone, without sanitizers");
      return;
    }
    mallopt(M_MMAP_THRESHOLD, 128 << 10);
    for (const Case& each : cases()) {
      Measured measured;
      const bool as_predicted = support::in_attempts(3, [&] {  // the system counts pages roughly
        measured = measure_apart(each);
        return measured.predicted >= measured.peak && measured.predicted <= 1.3 * measured.peak;
      });
      const std::string what =
          std::string(name(each.candidate.technique)) + " " + describe(each.candidate) + ", " + each.given;
      std::printf("%-75s predicted %6.1f MiB, used %6.1f, %.2f%s\n", what.c_str(), measured.predicted / mebi,
                  measured.peak / mebi, measured.predicted / measured.peak, as_predicted ? "" : " !");
      CHECK_MESSAGE(as_predicted, what);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("pairs that would not fit in memory are refused before allocation; the hits alone are found") {
    const std::vector<Disc> discs(1000, Disc{{0, 0, 0}, {0, 0, 1}, 1});
    const std::vector<Ray> rays(2000, Ray{{0.1, 0.2, -3}, {0, 0, 1}});
    const Problem problem = make_problem(rays, discs);
    const MemoryLimit limit(0x1p23);  // the pairs take 16 MB
    for (const Technique technique : {Technique::brute_force, Technique::octree})
      for (const bool plain : {false, true}) {
        Candidate candidate{technique, {}};
        if (technique == Technique::octree) candidate.parameters = OctreeParameters{1};
        INFO("name(technique) ", name(technique), ", plain ", plain);
        CHECK(run(problem, candidate, {.engine = plain ? Engine::plain : Engine::simd}).total_hits == 2'000'000);
        CHECK_THROWS_WITH_AS(
            (void)run(problem, candidate, {.pairs = true, .engine = plain ? Engine::plain : Engine::simd}),
            doctest::Contains("the pairs would take"), std::length_error);
      }
  }
}
