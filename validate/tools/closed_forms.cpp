/// Measures the time of one evaluation of each closed form.

#include <benchmark/benchmark.h>

#include <string>

#include "detp/model/accuracy/estimate_error.hpp"
#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/best_published_ratio.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"

namespace {

using namespace detp;
using namespace detp::model;

const Workload volume = cube_workload(1e6, 1e5, 0.01, 2);
const Workload surface = cube_workload(1e6, 1e5, 0.01, 2, 2);

Workload with_radius(double disc_radius) {
  Workload workload = volume;
  workload.disc_radius = disc_radius;
  return workload;
}

/// Evaluates with a ratio that changes from call to call, so that the compiler cannot reuse a result.
void add(const std::string& name, auto evaluate) {
  benchmark::RegisterBenchmark(name.c_str(), [evaluate](benchmark::State& state) {
    double ratio = 0.6;
    for (auto _ : state) {
      ratio = ratio > 0.7 ? 0.6 : ratio + 1e-7;
      benchmark::DoNotOptimize(evaluate(ratio));
    }
  });
}

void add_formulas() {
  add("sphere_count", [](double q) { return sphere_count(Form::corrected, {q}, {0.01}, {1.7}); });
  add("published::rays_in_sphere", [](double q) { return published::rays_in_sphere(1e6, {q}, 7); });
  add("published::rebuild_time", [](double q) { return published::rebuild_time(volume, {q}, 10, 1); });
  add("published::counts", [](double q) { return published::counts(volume, {q}, 10).cull_tests; });
  add("both_hit_share", [](double q) { return both_hit_share(1, q, 0.5); });
  add("optimal_ratio", [](double q) { return optimal_ratio(2 + q); });
  add("uniform_field_deviation", [](double q) { return uniform_field_deviation(1e6, {q}, {2}); });
  add("octree_counts, depth 6", [](double q) { return octree_counts(with_radius(0.01 * q), {6}).disc_tests; });
}

void add_sphere_cache() {
  for (const std::int64_t k : {1, 10, 100, 4096})
    add("sphere_cache_counts, volume, k " + std::to_string(k), [k](double q) {
      return sphere_cache_counts(volume, {q, k}).cull_tests;
    });
  add("sphere_cache_counts, surface, k 10", [](double q) { return sphere_cache_counts(surface, {q, 10}).cull_tests; });
}

void add_choices() {
  add("published::best_ratio", [](double q) { return published::best_ratio(with_radius(0.01 * q), {}).time; });
  add("best_ratio_and_stop", [](double q) { return best_ratio_and_stop(with_radius(0.01 * q), {}).time; });
  add("good_ratio_below", [](double q) { return good_ratio_below(with_radius(0.01 * q), {}, 1e300).time; });
  add("best_stop, Q = 0.65", [](double q) { return best_stop(with_radius(0.01 * q), {}, {0.65}).time; });
  add("rank all techniques", [](double q) { return rank(with_radius(0.01 * q), {}).size(); });
}

}  // namespace

int main(int argc, char** argv) {
  add_formulas();
  add_sphere_cache();
  add_choices();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
