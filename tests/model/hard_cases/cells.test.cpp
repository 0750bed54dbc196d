#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

/// 8^i (1 - (1 - 8^{-i})^{n_P}), also if 8^{-i} is below the last digit of 1.
Exact exact_occupied(double samples, int level) {
  if (level == 0) return 1;
  const Exact share = ldexp(Exact{1}, -3 * level);
  const Exact z = samples * (level < 2 ? support::log_of(1 - share) : support::log_next_to_1(-share));
  const Exact filled = z < -1e-30 ? Exact{1 - support::exp_of(std::max<Exact>(z, -1000))}
                                  : Exact{-z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4)))};
  return filled / share;
}

void compare_occupied(double samples, int level, Ledger& ledger) {
  ledger.compare("occupied cells", model::occupied_cell_spheres(samples, level), exact_occupied(samples, level),
                 [&] { return fmt::format("n_P {:g}, level {}", samples, level); });
}

void compare_radius(const Workload& w, int level, Ledger& ledger) {
  static const Exact half_root_of_3 = sqrt(Exact{3}) / 2;
  const Exact half_diagonal = ldexp(Exact{scene_side(w)}, -level) * half_root_of_3;
  ledger.compare("radius of a cell's sphere", model::cell_sphere_radius(w, level), half_diagonal + w.disc_radius,
                 [&] { return fmt::format("side {:a}, d {:a}, level {}", scene_side(w), w.disc_radius, level); });
}

void compare_random_cells(Draw& draw, Ledger& ledger) {
  const int level = static_cast<int>(draw.whole(0, 2) == 0 ? draw.whole(0, 300) : draw.whole(0, 25));
  compare_occupied(draw.rays_or_samples(), level, ledger);
  compare_radius(draw.workload(), level, ledger);
}

void compare_edge_cells(Ledger& ledger) {
  for (const int level : {0, 1, 2, 17, 18, 20, 110, 300})
    for (const double samples : {1.0, 2.0, 7.0, 8.0, 1e9, 1e18}) compare_occupied(samples, level, ledger);
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of cells: few samples in many cells and many in few") {
    Ledger ledger = on_random_inputs(9, few, compare_random_cells);
    compare_edge_cells(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("cells") { require_right_and_print(on_random_inputs(9, many, compare_random_cells)); }
}
