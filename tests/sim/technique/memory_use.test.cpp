#include <doctest/doctest.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "detp/sim/line_field.hpp"
#include "detp/sim/memory.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/sim/uniform_discs.hpp"
#include "support/sanitized.hpp"

// Predicted memory beside what the system says that the process held at its peak.

using namespace detp;
using namespace detp::sim;

namespace {

/// Bytes in a line of /proc/self/status, as "VmHWM".
double status(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(name + ":")) return 1024 * std::stod(line.substr(name.size() + 1));
  return 0;
}

/// Forgets the peak; false where the system does not allow that.
bool forget_peak() {
  std::ofstream file("/proc/self/clear_refs");
  file << 5;
  file.flush();
  return file.good();
}

template <class Work>
double peak_of(const Work& work) {
  malloc_trim(0);
  if (!forget_peak()) return 0;
  const double before = status("VmRSS");
  work();
  return status("VmHWM") - before;
}

struct Given {
  std::vector<Disc> discs;
  std::vector<Ray> rays;
};

Given medium(bool segments) {
  Given workload{uniform_discs(Body::cube, 2, 200'000, 0.01, 1), {}};
  workload.rays = LineField(enclosing_sphere(workload.discs), 2).lines(0, 150'000);
  if (segments)
    for (std::size_t i = 0; i < workload.rays.size(); ++i) {
      workload.rays[i].length = 0.3;
      workload.rays[i].power = 1.0 + static_cast<double>(i % 2);
    }
  return workload;
}

struct Case {
  Candidate candidate;
  bool plain = false;
};

/// Brute force and plain walks on so much would take too long, or take hardly any memory.
const std::vector<Case>& cases() {
  static const std::vector<Case> list{{{Technique::sphere_cache, SphereCacheParameters{0.65, 8}}},
                                      {{Technique::sphere_cache, SphereCacheParameters{0.9, 40}}},
                                      {{Technique::cell_spheres, CellSpheresParameters{5}}},
                                      {{Technique::sphere_tree, SphereTreeParameters{4, 16, Bounds::boxes}}},
                                      {{Technique::sphere_tree, SphereTreeParameters{2, 1, Bounds::boxes}}},
                                      {{Technique::sphere_tree, SphereTreeParameters{4, 64, Bounds::boxes}}},
                                      {{Technique::sphere_tree, SphereTreeParameters{8, 4}}},
                                      {{Technique::octree, OctreeParameters{5}}},
                                      {{Technique::octree, OctreeParameters{6, Traversal::neighbour_links}}},
                                      {{Technique::grid, GridParameters{60}}},
                                      {{Technique::grid, GridParameters{150}}},
                                      {{Technique::bsp, BspParameters{}}},
                                      {{Technique::bvh, BvhParameters{BuildQuality::low}}},
                                      {{Technique::bvh, BvhParameters{BuildQuality::medium}}}};
  return list;
}

}  // namespace

TEST_SUITE("memory") {
  TEST_CASE("no technique takes more memory than predicted, nor much less") {
    if (support::sanitized || !forget_peak()) {
      MESSAGE("skipped: the peak of this process cannot be measured");
      return;
    }
    for (const bool segments : {false, true}) {
      const Given workload = medium(segments);
      const Problem problem = make_problem(workload.rays, workload.discs);
      for (const Case& each : cases()) {
        Outcome outcome;
        std::array<double, 3> used{};  // what the heap happens to have at hand makes one differ now and then
        for (double& peak : used)
          peak = peak_of(
              [&] { outcome = run(problem, each.candidate, {.count = false, .plain = each.plain, .threads = 2}); });
        std::sort(used.begin(), used.end());
        const double median = used[1];
        std::printf("%-13s %-32s %s: predicted %6.1f MiB, used %6.1f, %.2f\n",
                    std::string(name(each.candidate.technique)).c_str(), describe(each.candidate.parameters).c_str(),
                    segments ? "segments" : "lines   ", outcome.bytes / 0x1p20, median / 0x1p20,
                    outcome.bytes / median);
        CAPTURE(name(each.candidate.technique));
        CAPTURE(describe(each.candidate.parameters));
        CHECK(outcome.bytes >= median);
        CHECK(outcome.bytes <= 1.3 * median);
      }
    }
  }
}
