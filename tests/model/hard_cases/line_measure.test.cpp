#include "detp/model/lines/line_measure.hpp"

#include <algorithm>

#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

void compare_bodies(double body, double outer, Ledger& ledger) {
  const auto inputs = [&] { return fmt::format("radius or side {:a}, r0 {:a}", body, outer); };
  const Exact share = Exact{body} / outer;
  ledger.compare("P(sphere)", model::sphere_hit_probability({body}, {outer}), share * share, inputs);
  ledger.compare("P(disc)", model::disc_hit_probability({body}, {outer}), share * share / 2, inputs);
}

Exact crossing(const Workload& w, const Exact& volume, const Exact& area) {
  const Exact r0 = w.sphere_radius;
  Exact space = 1;
  for (const double side : w.box) space *= side + 2 * Exact{w.disc_radius};
  return std::min<Exact>(1, w.path_length > 0 ? Exact{(volume + w.path_length * area / 4) / space}
                                              : Exact{area / (4 * support::pi() * r0 * r0)});
}

void compare_workload(const Workload& w, double volume, double area, Ledger& ledger) {
  const auto inputs = [&] {
    return fmt::format("n_R {:g}, n_P {:g}, d {:a}, r0 {:a}, box {:a} {:a} {:a}, path {:a}, V {:a}, F {:a}", w.rays,
                       w.samples, w.disc_radius, w.sphere_radius, w.box[0], w.box[1], w.box[2], w.path_length, volume,
                       area);
  };
  const bool segments = w.path_length > 0;
  ledger.compare(segments ? "P(body), segments" : "P(body), lines", model::crossing_probability(w, volume, area),
                 crossing(w, volume, area), inputs);
  const Exact d = w.disc_radius;
  ledger.compare(segments ? "expected hits, segments" : "expected hits, lines", model::expected_hits(w),
                 Exact{w.rays} * w.samples * crossing(w, 0, 2 * support::pi() * d * d), inputs);
}

void compare_random_lines(Draw& draw, Ledger& ledger) {
  const double outer = draw.anywhere();
  compare_bodies(std::max(outer * draw.log_uniform(1e-300, 1.15), 5e-324), outer * 1.16, ledger);
  Workload w = draw.workload();
  const double r0 = w.sphere_radius;
  if (draw.whole(0, 1) == 1) w.path_length = draw.whole(0, 3) == 0 ? draw.anywhere() : r0 * draw.log_uniform(1e-12, 2);
  const bool like_scene = draw.whole(0, 3) > 0;
  compare_workload(w, like_scene ? r0 * r0 * r0 * draw.log_uniform(1e-30, 1) : draw.anywhere(),
                   like_scene ? r0 * r0 * draw.log_uniform(1e-30, 10) : draw.anywhere(), ledger);
}

void compare_edge_lines(Ledger& ledger) {
  for (const double outer : {1e-300, 1.0, 1.7e308})
    for (const double share : {5e-324, 1e-300, 1e-160, 1e-154, 0.5, 0.8})
      compare_bodies(std::max(share * outer, 5e-324), outer, ledger);
  for (const double scale : {1e-90, 1.0, 1e90})
    for (const double disc : {5e-324, 1e-300, 1e-160, 0.01 * scale, scale, 1e3 * scale, 1.7e308})
      for (const double path : {0.0, 5e-324, 1e-300, scale, 1.7e308})
        for (const double flat : {0.0, 1.0})
          for (const double body : {0.0, 5e-324, 1.7e308})
            compare_workload({.rays = 1e18,
                              .samples = 1e18,
                              .disc_radius = disc,
                              .sphere_radius = scale,
                              .box = {scale, flat * scale, flat * scale},
                              .path_length = path},
                             body, body, ledger);
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of line measures: squares that over- or underflow, flat boxes, long paths") {
    Ledger ledger = on_random_inputs(4, few, compare_random_lines);
    compare_edge_lines(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("line measures") { require_right_and_print(on_random_inputs(4, many, compare_random_lines)); }
}
