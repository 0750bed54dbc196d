#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;
using model::sphere_count;
using support::power;

namespace {

struct CountCase {
  double ratio;
  double disc;
  double outer;
};

/// Corrected k: r_k >= d > r_{k+1}. Published k: equal to the corrected k if r_k = d, else larger by one.
void compare_count(const CountCase& c, Ledger& ledger) {
  const auto [q, d, r0] = c;
  const auto inputs = [&] { return fmt::format("Q {:a}, d {:a}, r0 {:a}", c.ratio, c.disc, c.outer); };
  try {
    const std::int64_t corrected = sphere_count(Form::corrected, {q}, {d}, {r0});
    const std::int64_t published = sphere_count(Form::published, {q}, {d}, {r0});
    const Exact radius = r0 * power(q, corrected);
    const bool right = d < r0 ? radius >= d && radius * q < d : corrected == 0;
    ledger.compare_whole("k, corrected", corrected, right, inputs);
    const std::int64_t one_more = d < r0 && radius > d ? 1 : 0;
    ledger.compare_whole("k, published", published, right && published == corrected + one_more, inputs);
  } catch (const std::overflow_error&) {
    ledger.compare_whole("k beyond 9e18, refused", -1, r0 * power(q, 8'999'999'999'999'999'000) > d, inputs);
  }
}

/// d, and the doubles next to it.
std::array<double, 3> around(double d) { return {std::nextafter(d, 0.0), d, std::nextafter(d, 2 * d)}; }

void compare_count_around(const CountCase& c, Ledger& ledger) {
  for (const double d : around(c.disc))
    if (d > 0) compare_count({c.ratio, d, c.outer}, ledger);
}

void compare_random_counts(Draw& draw, Ledger& ledger) {
  const double q = draw.ratio();
  const double r0 = draw.anywhere();
  const double log_radii = -std::log(q) * static_cast<double>(draw.index(q));
  const double tie = r0 * std::exp(-log_radii);
  const bool near_tie = draw.whole(0, 1) == 0 && tie > 1e-323;
  const double d = near_tie ? around(tie)[static_cast<std::size_t>(draw.whole(0, 2))] : draw.log_uniform(5e-324, r0);
  compare_count({q, d, r0}, ledger);
}

void compare_edge_counts(Ledger& ledger) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  const auto compare_next_to = [&](double q) {
    for (const double ratio : {std::nextafter(q, 0.0), q, std::nextafter(q, 1.0)}) {
      if (ratio <= 0 || ratio >= 1) continue;
      compare_count_around({ratio, ratio, 1}, ledger);  // exactly r_1 = d
      for (const double d : {1 - 0x1p-53, 0.3, 1e-300, least}) compare_count({ratio, d, 1}, ledger);
    }
  };
  for (int n = 1; n <= 53; ++n) compare_next_to(1 - std::ldexp(1.0, -n));
  for (int n = 2; n <= 1074; ++n) compare_next_to(std::ldexp(1.0, -n));
  for (const double q : {0.5, 0.25, 0x1p-10, 0.65, 2.0 / 3, 0.99, 1 - 0x1p-20})
    for (const double r0 : {1.0, 0x1p-40, 0x1p+900, 3.7e-5})
      for (int j = 1; j < 60; ++j) compare_count_around({q, r0 * std::pow(q, j), r0}, ledger);
  for (int n = 1; n <= 4; ++n)  // Q a few ulps below 1, d a few ulps below r0
    for (int steps = 1; steps <= 8; ++steps)
      for (const double r0 : {1.0, 1.7, 0x1.8p-900, 3e300}) {
        double d = r0;
        for (int step = 0; step < steps; ++step) d = std::nextafter(d, 0.0);
        compare_count({1 - n * 0x1p-53, d, r0}, ledger);
      }
  for (const double q : {least, 0.5, 1 - 0x1p-53})
    for (const double d : {1.0, 1 + 0x1p-52, 2.0, 1e308}) compare_count({q, d, 1}, ledger);
}

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
  ledger.compare(
      "occupied cells", model::occupied_cell_spheres(samples, level), exact_occupied(samples, level),
      [&] { return fmt::format("n_P {:g}, level {}", samples, level); }, 1e-15);
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
  TEST_CASE("hard cases of k: Q next to 0 and to 1, d next to r0 Q^j, d next to and beyond r0") {
    Ledger ledger = on_random_inputs(1, few, compare_random_counts);
    compare_edge_counts(ledger);
    require_right(ledger);
  }

  TEST_CASE("hard cases of cells: few samples in many cells and many in few") {
    Ledger ledger = on_random_inputs(9, few, compare_random_cells);
    compare_edge_cells(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("discs as large as S0 or larger: no sphere pays off, and choose returns brute force") {
    for (const double share : {1.0, 1 + 0x1p-52, 7.0}) {
      const Workload w{
          .rays = 1e6, .samples = 1e6, .disc_radius = share, .sphere_radius = 1, .box = {1e-3, 1e-3, 1e-3}};
      const UnitCosts costs{.cull_test = 1, .disc_test = 1, .step = 1, .node = 1, .placement = 1};
      CHECK(!model::best_of(Technique::sphere_cache, w, costs));
      CHECK(model::rank(w, costs).front().candidate.technique == Technique::brute_force);
    }
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("k") { require_right_and_print(on_random_inputs(1, many, compare_random_counts)); }

  TEST_CASE("cells") { require_right_and_print(on_random_inputs(9, many, compare_random_cells)); }
}
