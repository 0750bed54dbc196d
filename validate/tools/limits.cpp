// Makes notebooks-data/limits.csv: times of whole searches beside the least that this machine needs for them.
//
//   cmake --build build --target limits && (build/limits AVX3; build/limits AVX2; build/limits SSE4) > notebooks-data/limits.csv
//
// Our choice on one thread, from discs and rays in memory to irradiance in memory: the first run, for which kept
// memory was given back, and the median of seven more. The limit is a sum over phases that follow one another, each at a rate that is measured at the start
// (machine_peak.cpp):
//
//     move    bytes of rays and discs, read once, and of hits and irradiance, written once, at the bandwidth of loads of so many bytes
//     tests   floating-point operations of the counted tests against boxes and discs, and of loading, at the peak of multiply-adds
//     pack    packing and storing the vectors that keep a ray, the fastest way, from the second-level cache. That each lane is kept with the same
//             probability is assumed, which counts too many vectors
//
// "load" is the time of bringing all rays into lists, measured alone. Takes about a minute a set.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/page_pool.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/sim/lists/simd/ray_blocks.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/choice.hpp"
#include "kernel_table.hpp"

namespace {

using namespace detp;
using namespace detp::benchmarks;

struct Searched {
  double rays;
  double discs;
  double radius;  ///< of discs in or on a cube of side 1
  sim::Body body;
  bool segments;
};

constexpr std::array workloads{
    Searched{1e3, 1e3, 0.05, sim::Body::cube, false},        Searched{1e4, 1e3, 0.05, sim::Body::cube_faces, false},
    Searched{1e3, 1e5, 0.01, sim::Body::cube, false},        Searched{1e5, 1e4, 0.02, sim::Body::cube_faces, true},
    Searched{1e5, 1e5, 0.01, sim::Body::cube, false},        Searched{1e6, 1e3, 0.02, sim::Body::cube, false},
    Searched{1e6, 1e3, 0.01, sim::Body::cube, true},         Searched{8e5, 6e4, 0.004, sim::Body::cube_faces, true},
    Searched{1e4, 1e6, 0.002, sim::Body::cube_faces, false}, Searched{1e6, 1e6, 0.002, sim::Body::cube, false},
    Searched{1e7, 1e4, 0.01, sim::Body::cube_faces, false},  Searched{1e5, 1e7, 0.0005, sim::Body::cube_faces, false}};

/// Lines through the sphere around the discs, or pieces of such lines: up to 0.8 long, from a uniform place around the middle on.
std::vector<sim::Ray> rays_of(const Searched& workload, std::span<const sim::Disc> discs) {
  std::vector<sim::Ray> rays =
      sim::LineField(sim::enclosing_sphere(discs), 2).lines(0, static_cast<std::size_t>(workload.rays));
  if (!workload.segments) return rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto drawn = sim::uniform4(3, sim::Stream::structure, i);
    rays[i].origin += (drawn[0] - 0.8) * rays[i].direction;
    rays[i].length = 0.8 * drawn[1];
  }
  return rays;
}

struct Phases {
  double check = 0;
  double choose = 0;
  double order = 0;
  double build = 0;
  double search = 0;
  [[nodiscard]] double total() const { return check + choose + order + build + search; }
};

struct Run {
  Phases phases;
  Candidate candidate;
  sim::Outcome outcome;
};

Run run(std::span<const sim::Ray> rays, std::span<const sim::Disc> discs, bool count) {
  sim::Stopwatch watch;
  const sim::Problem problem = sim::make_problem(rays, discs);
  Run all;
  all.phases.check = watch.lap();
  validate::Choice choice = validate::choose(
      {.problem = &problem, .purpose = validate::Purpose::one_search, .threads = 1}, validate::built_in_unit_costs());
  all.phases.choose = watch.lap();
  const sim::RunOptions how{.count = count, .threads = 1};
  const auto index = validate::build_choice(choice, problem, how);
  const double building = watch.lap();
  all.outcome = sim::run(problem, *index, how);
  all.phases.search = watch.lap();
  all.phases.order = all.outcome.seconds.order;
  all.phases.build = std::max(0.0, building - all.phases.order);
  all.candidate = choice.best().candidate;
  return all;
}

/// Seconds for bringing all rays into lists.
double loading(std::span<const sim::Ray> rays, std::span<const sim::Disc> discs) {
  const sim::Problem problem = sim::make_problem(rays, discs);
  const sim::stream::Frame frame(problem);
  sim::stream::Block block(&sim::page_pool(), false);
  double least = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const sim::Stopwatch watch;
    for (std::size_t first = 0; first < rays.size(); first += rays_in_block(discs.size()))
      block.load(problem, frame, first, rays_in_block(discs.size()));
    least = std::min(least, watch.seconds());
  }
  return least;
}

void write_row(const Searched& workload, double flops) {
  const auto discs = sim::uniform_discs(workload.body, 1, static_cast<std::size_t>(workload.discs), workload.radius, 1);
  const std::vector<sim::Ray> rays = rays_of(workload, discs);
  sim::release_kept_pages();
  sim::return_freed_memory();
  const Run first = run(rays, discs, false);
  std::vector<Run> runs;
  for (int i = 0; i < 7; ++i) {
    runs.push_back(run(rays, discs, false));
    runs.back().outcome = {};
  }
  std::ranges::sort(runs, {}, [](const Run& one) { return one.phases.total(); });
  const Phases& median = runs[runs.size() / 2].phases;
  const Run counted = run(rays, discs, true);
  const Counts<std::uint64_t>& counts = counted.outcome.counts;
  const auto culls = static_cast<double>(counts.cull_tests);
  const auto tests = static_cast<double>(counts.disc_tests);
  const double bytes = sizeof(sim::Ray) * workload.rays + (sizeof(sim::Disc) + 16) * workload.discs;
  const double moving = bytes / load_bandwidth(static_cast<std::size_t>(std::clamp(bytes, 4096.0, 0x1p28)));
  const double operations =
      box_flops[workload.segments] * culls + disc_flops[workload.segments] * tests + load_flops * workload.rays;
  const double share = culls == 0 ? 0 : static_cast<double>(counts.listed) / culls;
  const double any = 1 - std::pow(1 - share, static_cast<double>(vector_length()));
  double of_vector = 1;
  for (const Packing packing : {Packing::permute, Packing::pairs})
    of_vector = std::min(of_vector, packing_time(packing, workload.segments ? 7 : 5, 4096, share));
  const double packing = static_cast<double>(counted.outcome.vectors.cull) * any * of_vector;
  const double limit = moving + operations / flops + packing;
  constexpr double milli = 1e3;
  fmt::print("{},{},{:.0f},{:.0f},{},{},\"{}\",{:.4g},{:.4g},{:.4g},{:.4g}", instructions(),
             workload.body == sim::Body::cube ? "cube" : "faces", workload.rays, workload.discs, workload.radius,
             workload.segments ? "segments" : "lines", describe(counted.candidate), 1e-6 * bytes, culls / workload.rays,
             tests / workload.rays, static_cast<double>(counts.hits) / workload.rays);
  for (const double seconds :
       {moving, operations / flops, packing, limit, first.phases.total(), median.total(), median.check, median.choose,
        median.order + median.build, loading(rays, discs), median.search})
    fmt::print(",{:.4g}", milli * seconds);
  fmt::print(",{:.3f}\n", limit / median.total());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<sim::stream::OnlyInstructionSet> only;
  if (argc > 1) only.emplace(argv[1]);
  fmt::print(
      "set,discs_in,rays,discs,disc_radius,field,parameters,megabytes,culls_a_ray,tests_a_ray,hits_a_ray,move_ms,test_"
      "ms,pack_ms,limit_ms,"
      "first_ms,all_ms,check_ms,choose_ms,build_ms,load_ms,search_ms,share\n");
  const double flops = peak_flops();
  for (const Searched& workload : workloads) write_row(workload, flops);
}
