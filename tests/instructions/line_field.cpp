// Lines of a uniform field against uniform discs, written by hand or by way of a job without effects. Prints the hits. The test
// `off-path` compares how many instructions both take, in valgrind, which offers AVX2 on any machine.
//
//   line_field hand|job

#include <fmt/format.h>
#include <hwy/nanobenchmark.h>
#include <tbb/global_control.h>

#include <string_view>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/job/job.hpp"

// Highway's library measures its timer when it is loaded. On processors that hide the instruction RDTSCP, valgrind 3.19 tells
// programs that it is there, and ends them when they use it. The library calls this function instead of its own.
std::uint64_t hwy::platform::TimerResolution() { return 1; }

namespace {

using namespace detp;

constexpr std::size_t samples = 20'000;
constexpr std::size_t lines = 100'000;
constexpr double radius = 0.02;
constexpr double side = 2;
const Candidate tree{Technique::box_tree, BoxTreeParameters{8, 16}};
const sim::RunOptions one_thread{.threads = 1};

std::uint64_t hits_by_hand() {
  const auto discs = sim::uniform_discs(sim::Body::cube, side, samples, radius, 1);
  const auto rays = sim::LineField({glm::dvec3{0.0}, enclosing_radius(side, radius)}, 1).lines(0, lines);
  return sim::run(sim::make_problem(rays, discs), tree, one_thread).total_hits;
}

std::uint64_t hits_of_job() {
  validate::JobRequest request;
  request.rays = lines;
  request.samples = samples;
  request.disc_radius = validate::Length{radius};
  request.scene_side = side;
  request.effects = sim::EffectSelection("none");
  const validate::Job job = validate::make_job(request);
  return sim::run(job.problem(), tree, one_thread).total_hits;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  // One thread alone: how long idle threads look for work differs from run to run.
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  fmt::print("{}\n", std::string_view(argv[1]) == "hand" ? hits_by_hand() : hits_of_job());
}
