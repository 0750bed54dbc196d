#include <algorithm>
#include <cmath>

#include "detp/model/accuracy/estimate_error.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/optimal_ratio.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

/// The double after x, or x times a factor of up to 11; at most `most`.
double larger(double x, double most, Draw& draw) {
  const double more = draw.whole(0, 2) == 0 ? std::nextafter(x, most) : x * (1 + draw.log_uniform(1e-16, 10));
  return std::min(more, most);
}

/// Records whether low <= high. `rounding` is the relative violation that the formula's documentation allows.
template <class Describe>
void compare_order(const char* claim, double low, double high, Ledger& ledger, const Describe& inputs,
                   double rounding = 0) {
  ledger.compare_whole(claim, low > high ? 1 : 0, low <= high * (1 + rounding),
                       [&] { return fmt::format("{}: {:a} before {:a}", inputs(), low, high); });
}

void compare_cache(Draw& draw, Ledger& ledger) {
  using namespace model;
  const double q = draw.ratio();
  const double more_q = larger(q, 1 - 0x1p-53, draw);
  const std::int64_t i = std::min(draw.index(q), std::int64_t{1'000'000'000'000'000'000});
  const std::int64_t more_i = i + static_cast<std::int64_t>(draw.count(1, 1e18));
  Workload w = draw.workload();
  Workload more_w = w;
  more_w.samples = std::floor(larger(w.samples, 1e18, draw));
  const auto inputs = [&] {
    return fmt::format("Q {:a} {:a}, i {} {}, n_R {:g}, n_P {:.17g} {:.17g}, d {:a}, r0 {:a}", q, more_q, i, more_i,
                       w.rays, w.samples, more_w.samples, w.disc_radius, w.sphere_radius);
  };
  const auto order = [&](const char* claim, double low, double high) {
    compare_order(claim, low, high, ledger, inputs);
  };
  order("n_i falls with i", published::rays_in_sphere(w.rays, {q}, more_i), published::rays_in_sphere(w.rays, {q}, i));
  order("n_i grows with Q", published::rays_in_sphere(w.rays, {q}, i), published::rays_in_sphere(w.rays, {more_q}, i));
  order("m_i grows with i", published::rebuilds({q}, i), published::rebuilds({q}, more_i));
  order("m_i falls with Q", published::rebuilds({more_q}, i), published::rebuilds({q}, i));
  order("T_R grows with k", published::rebuild_time(w, {q}, i, 1), published::rebuild_time(w, {q}, i + 1, 1));
  order("T_R grows with k", published::rebuild_time(w, {q}, i, 1), published::rebuild_time(w, {q}, more_i, 1));
  order("T_R grows with n_P", published::rebuild_time(w, {q}, i, 1), published::rebuild_time(more_w, {q}, i, 1));
  order("rebuilds grow with k", published::counts(w, {q}, i).culls, published::counts(w, {q}, more_i).culls);
  order("rebuilds grow with n_P", published::counts(w, {q}, i).culls, published::counts(more_w, {q}, i).culls);
  order("T_I falls with k", published::intersect_time(w, {q}, more_i, 1), published::intersect_time(w, {q}, i, 1));
  order("T_R for few grows with n_P", published::rebuild_time_few_samples(w, {q}, 1),
        published::rebuild_time_few_samples(more_w, {q}, 1));
  order("hits grow with n_P", expected_hits(w), expected_hits(more_w));
}

void compare_count(Draw& draw, Ledger& ledger) {
  using namespace model;
  const double q = std::min(draw.ratio(), 0.99);  // k <= 9e18
  const double more_q = larger(q, 0.995, draw);
  const double r0 = draw.anywhere();
  const double d = draw.log_uniform(5e-324, r0);
  const double more_d = larger(d, r0, draw);
  const auto inputs = [&] { return fmt::format("Q {:a} {:a}, d {:a} {:a}, r0 {:a}", q, more_q, d, more_d, r0); };
  for (const Form form : {Form::published, Form::corrected}) {
    const std::int64_t k = sphere_count(form, {q}, {d}, {r0});
    const std::int64_t with_more_q = sphere_count(form, {more_q}, {d}, {r0});
    const std::int64_t with_more_d = sphere_count(form, {q}, {more_d}, {r0});
    ledger.compare_whole("k grows with Q", with_more_q, with_more_q >= k, inputs);
    ledger.compare_whole("k falls with d", with_more_d, with_more_d <= k, inputs);
  }
}

void compare_others(Draw& draw, Ledger& ledger) {
  using namespace model;
  const double dimension = draw.uniform(1, 3);
  const double more_dimension = larger(dimension, 3, draw);
  const double r0 = draw.anywhere();
  const double d = r0 * draw.log_uniform(1e-12, 1);
  const double more_d = larger(d, r0, draw);
  const double rays = draw.rays_or_samples();
  const double more_rays = std::floor(larger(rays, 1e18, draw));
  const int level = static_cast<int>(draw.whole(0, 300));
  const auto inputs = [&] {
    return fmt::format("D {:a} {:a}, d {:a} {:a}, r0 {:a}, n {:.17g} {:.17g}, level {}", dimension, more_dimension, d,
                       more_d, r0, rays, more_rays, level);
  };
  const auto order = [&](const char* claim, double low, double high) {
    compare_order(claim, low, high, ledger, inputs);
  };
  order("Q* grows with D", optimal_ratio(dimension), optimal_ratio(more_dimension));
  order("P(disc) grows with d", disc_hit_probability({d}, {r0}), disc_hit_probability({more_d}, {r0}));
  order("deviation falls with d", uniform_field_deviation(rays, {more_d}, {r0}),
        uniform_field_deviation(rays, {d}, {r0}));
  order("deviation falls with n_R", uniform_field_deviation(more_rays, {d}, {r0}),
        uniform_field_deviation(rays, {d}, {r0}));
  order("occupied cells grow with n_P", occupied_cell_spheres(rays, level), occupied_cell_spheres(more_rays, level));
  compare_order("occupied cells grow with the level", occupied_cell_spheres(rays, level),
                occupied_cell_spheres(rays, std::min(300, level + 1)), ledger, inputs, 4 * 0x1p-52);
  const double b = d / r0;
  const double c = draw.log_uniform(1e-3, 1e3);
  const double more_c = larger(c, 1e5, draw);
  compare_order(
      "share of both falls with c", both_hit_share(1, b, more_c), both_hit_share(1, b, c), ledger,
      [&] { return fmt::format("a 1, b {:a}, c {:a} {:a}", b, c, more_c); }, 1e-15);
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("monotone formulas are monotone in doubles: over steps of one ulp, and of up to a factor of 10") {
    Ledger ledger = on_random_inputs(11, few, compare_cache);
    ledger.merge(on_random_inputs(12, few, compare_count));
    ledger.merge(on_random_inputs(13, few, compare_others));
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("monotonicity") {
    Ledger ledger = on_random_inputs(11, many / 4, compare_cache);
    ledger.merge(on_random_inputs(12, many / 4, compare_count));
    ledger.merge(on_random_inputs(13, many / 4, compare_others));
    require_right_and_print(ledger);
  }
}
