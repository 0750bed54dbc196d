#include "detp/model/sphere_cache/sphere_count.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/model/rank/choose.hpp"
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
  for (const double q : {least, 0.5, 1 - 0x1p-53})
    for (const double d : {1.0, 1 + 0x1p-52, 2.0, 1e308}) compare_count({q, d, 1}, ledger);
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of k: Q next to 0 and to 1, d next to r0 Q^j, d next to and beyond r0") {
    Ledger ledger = on_random_inputs(1, few, compare_random_counts);
    compare_edge_counts(ledger);
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
}
