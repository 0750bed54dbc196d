#include "detp/model/vocabulary/workload.hpp"

#include <algorithm>
#include <cmath>

#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

/// ln(volume^(D - 2) area^(3 - D)); a side counts as at least a millionth of the longest.
Exact log_of_extent(const Workload& w) {
  if (w.sample_extent > 0) return support::log_of(w.sample_extent);
  const Exact sliver = Exact{1e-6} * scene_side(w);
  const Exact x = std::max<Exact>(w.box[0], sliver);
  const Exact y = std::max<Exact>(w.box[1], sliver);
  const Exact z = std::max<Exact>(w.box[2], sliver);
  const Exact weight = std::max(0.0, w.dimension - 2);
  return weight * support::log_of(x * y * z) + (1 - weight) * support::log_of(2 * (x * y + y * z + z * x));
}

void compare(const Workload& w, Ledger& ledger) {
  const auto inputs = [&] {
    return fmt::format("box {:a} {:a} {:a}, n_P {:g}, D {:a}, extent {:a}", w.box[0], w.box[1], w.box[2], w.samples,
                       w.dimension, w.sample_extent);
  };
  static const Exact half_root_of_3 = sqrt(Exact{3}) / 2;
  const Exact log_extent = log_of_extent(w);
  ledger.compare("extent of the samples", sample_extent(w), support::exp_of(log_extent), inputs);
  ledger.compare("distance of the samples", sample_distance(w),
                 support::exp_of((log_extent - support::log_of(w.samples)) / w.dimension), inputs);
  ledger.compare("radius around a cube", enclosing_radius(scene_side(w), w.disc_radius),
                 scene_side(w) * half_root_of_3 + w.disc_radius, inputs);
}

void compare_random_workloads(Draw& draw, Ledger& ledger) {
  Workload w = draw.workload();
  const std::int64_t kind = draw.whole(0, 3);
  w.dimension = kind == 0 ? 2 : kind == 1 ? 3 : draw.uniform(1, 3);
  if (draw.whole(0, 3) == 0) w.sample_extent = draw.anywhere();
  compare(w, ledger);
}

void compare_edge_workloads(Ledger& ledger) {
  for (const double side : {1e-90, 1.0, 1e90})
    for (const double flat : {0.0, 1e-6, 1.0})
      for (const double dimension :
           {1.0, std::nextafter(2.0, 1.0), 2.0, std::nextafter(2.0, 3.0), std::nextafter(3.0, 2.0), 3.0})
        for (const double samples : {1.0, 1e18})
          for (const double extent : {0.0, 5e-324, 1.79e308})
            compare({.rays = 1,
                     .samples = samples,
                     .disc_radius = 1e-300,
                     .sphere_radius = side,
                     .box = {side, side * flat, side * flat},
                     .dimension = dimension,
                     .sample_extent = extent},
                    ledger);
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of a workload: flat boxes at both limits of the scale, D next to 2 and 3, any extent") {
    Ledger ledger = on_random_inputs(10, few, compare_random_workloads);
    compare_edge_workloads(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("workload") { require_right_and_print(on_random_inputs(10, many, compare_random_workloads)); }
}
