#include <cmath>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;
namespace published = detp::model::published;

namespace {

/// Compares the depth with the largest k >= 0 for which 2^{k+1} d <= s; 0 if there is none.
void compare_depth(double d, double side, Ledger& ledger) {
  const int depth = published::octree_depth({d}, side);
  const bool narrow_enough = depth == 0 || ldexp(Exact{d}, depth + 1) <= side;
  ledger.compare_whole("octree depth, published", depth, narrow_enough && ldexp(Exact{d}, depth + 2) > side,
                       [&] { return fmt::format("d {:a}, s {:a}", d, side); });
}

void compare_depths_around(double d, double side, Ledger& ledger) {
  for (const double disc : {std::nextafter(d, 0.0), d, std::nextafter(d, 1e308)})
    if (disc > 0 && std::isfinite(disc)) compare_depth(disc, side, ledger);
}

void compare_costs(const Workload& w, int depth, double disc_test, Ledger& ledger) {
  const auto inputs = [&] {
    return fmt::format("depth {}, n_R {:g}, n_P {:g}, u {:a}", depth, w.rays, w.samples, disc_test);
  };
  const Exact tests = ldexp(Exact{w.samples}, -2 * depth);
  const Exact time = disc_test * (w.rays * tests);
  ledger.compare("cells of a line, published", published::cells_per_line(depth), ldexp(Exact{1}, depth), inputs);
  ledger.compare("discs in a cell, published", published::discs_per_cell(w.samples, depth),
                 ldexp(Exact{w.samples}, -3 * depth), inputs);
  ledger.compare("tests of a line, published", published::tests_per_line(w.samples, depth), tests, inputs);
  ledger.compare("T of an octree, published", published::octree_time(w, depth, disc_test), depth * time, inputs);
  ledger.compare("T balanced, published", published::balanced_octree_time(w, depth, disc_test), time, inputs);
}

void compare_random_octrees(Draw& draw, Ledger& ledger) {
  const double side = draw.anywhere();
  compare_depth(draw.log_uniform(5e-324, side), side, ledger);
  compare_depths_around(std::ldexp(side, -static_cast<int>(draw.whole(0, 1000))), side, ledger);
  compare_costs(draw.workload(), static_cast<int>(draw.count(1, 2097)) - 1, draw.factor(), ledger);
}

void compare_edge_octrees(Ledger& ledger) {
  for (const double side : {5e-324, 0x1p-1022, 1e-300, 1.0, 2.0, 0x1.fffffffffffffp+0, 1.79e308})
    for (int n = -3; n <= 2100; n += n < 70 ? 1 : 37) compare_depths_around(std::ldexp(side, -n), side, ledger);
  Workload w{.disc_radius = 1, .sphere_radius = 1, .box = {1, 1, 1}};
  for (const int depth : {0, 1, 30, 340, 500, 1023, 1024, 2096})
    for (const double count : {1.0, 1e18})
      for (const double disc_test : {0.0, 5e-324, 1e-9, 1.79e308}) {
        w.rays = w.samples = count;
        compare_costs(w, depth, disc_test, ledger);
      }
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of the published octree: powers of two and their neighbours, all possible depths") {
    Ledger ledger = on_random_inputs(8, few, compare_random_octrees);
    compare_edge_octrees(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("published octree") { require_right_and_print(on_random_inputs(8, many, compare_random_octrees)); }
}
