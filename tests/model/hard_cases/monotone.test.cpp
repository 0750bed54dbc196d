#include <doctest/doctest.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "detp/model/accuracy/estimate_error.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;
using detp::support::relative_error;

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

/// One candidate of each technique that has a corrected form, with parameters from their whole range.
std::vector<Candidate> draw_candidates(Draw& draw) {
  const double ratio = draw.ratio();
  const auto order = draw.whole(0, 3) > 0 ? SampleOrder::lebesgue : SampleOrder::none;
  // Some of these numbers of spheres are far larger than the number of spheres that can hold a disc. They are at most
  // 1000, to save time.
  const std::int64_t spheres =
      draw.whole(0, 7) > 0 ? draw.whole(1, 40) : std::min<std::int64_t>(draw.index(ratio), 1000);
  return {{Technique::brute_force, BruteForceParameters{}},
          {Technique::sphere_cache, SphereCacheParameters{ratio, spheres, order}},
          {Technique::cell_spheres, CellSpheresParameters{static_cast<int>(draw.whole(0, 16))}},
          {Technique::sphere_tree,
           SphereTreeParameters{static_cast<int>(draw.count(2, 1e6)), static_cast<int>(draw.count(1, 1e6))}},
          {Technique::box_tree,
           BoxTreeParameters{static_cast<int>(draw.count(2, 100)), static_cast<int>(draw.count(1, 1e3))}},
          {Technique::octree, OctreeParameters{static_cast<int>(draw.whole(0, 20))}},
          {Technique::grid, GridParameters{static_cast<int>(draw.count(1, 1e6))}}};
}

std::string describe(const Workload& w, const Candidate& candidate) {
  return fmt::format("{} {}: n_R {:g}, n_P {:g}, d {:a}, r0 {:a}, box {:a} {:a} {:a}, D {:a}",
                     name(candidate.technique), detp::describe(candidate), w.rays, w.samples, w.disc_radius,
                     w.sphere_radius, w.box[0], w.box[1], w.box[2], w.dimension);
}

/// Tables and fits have no exact value to compare with, but every input must give valid counts.
void require_counts(std::uint64_t index) {
  Draw draw(90, index);
  Workload w = draw.workload();
  const std::int64_t kind = draw.whole(0, 2);
  w.dimension = kind == 0 ? 2 : kind == 1 ? 3 : draw.uniform(1, 3);
  for (const Candidate& candidate : draw_candidates(draw)) {
    INFO(describe(w, candidate));
    const Counts<double> counts = model::predict(w, candidate);
    for_each_term(counts, [&](std::string_view term, double value) {
      CAPTURE(term);
      REQUIRE(std::isfinite(value));
      REQUIRE(value >= 0);
    });
    if (!std::holds_alternative<OctreeParameters>(candidate.parameters) &&
        !std::holds_alternative<GridParameters>(candidate.parameters))  // an index tests a disc in each of its cells
      REQUIRE(counts.disc_tests <= w.rays * w.samples * (1 + 1e-12));
  }
}

constexpr double largest = std::numeric_limits<double>::max();
constexpr double least = std::numeric_limits<double>::denorm_min();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The ledger of a formula that is wrong by `factor`, on a few random inputs.
Ledger of_square_times(double factor) {
  return on_random_inputs(99, 100, [&](Draw& draw, Ledger& ledger) {
    const double x = draw.log_uniform(1e-100, 1e100);
    ledger.compare("square", x * x * factor, Exact{x} * x, [&] { return fmt::format("x {:a}", x); });
  });
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

  TEST_CASE("a million predictions, seven candidates on each of 170 000 workloads: every count finite, not negative") {
    tbb::parallel_for(std::uint64_t{0}, std::uint64_t{170'000}, require_counts);
  }
}

TEST_SUITE("corrected") {
  TEST_CASE("every count of every technique is finite and not negative, and no disc meets more rays than there are") {
    for (std::uint64_t index = 0; index < 3000; ++index) require_counts(index);
  }
}

TEST_SUITE("negative control") {
  TEST_CASE("a formula off by 1e-12 is refused on every input, and reported; a right one is accepted") {
    const Ledger wrong = of_square_times(1 + 1e-12);
    CHECK(wrong.failures() == 100);
    CHECK(wrong.entries().at("square").inputs == 100);
    CHECK(wrong.entries().at("square").worst == doctest::Approx(1e-12).epsilon(1e-3));
    for (const char* part : {"100 values are off", "square off by 1e-12", "at x 0x1.", "expected ", "got "})
      CHECK(wrong.report().find(part) != std::string::npos);
    CHECK(of_square_times(1).failures() == 0);
  }

  TEST_CASE("a wrong whole number is refused") {
    Ledger ledger;
    ledger.compare_whole("k", 7, false, [] { return "here"; });
    CHECK(ledger.failures() == 1);
    CHECK(ledger.report().find("k off by 1 at here: got 7") != std::string::npos);
  }

  TEST_CASE("an exception of a check on another thread reaches the test") {
    CHECK_THROWS_AS((void)on_random_inputs(99, 10, [](Draw&, Ledger&) { throw std::domain_error("here"); }),
                    std::domain_error);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("any value that is not finite has an infinite error") {
    for (const double bad : {infinity, -infinity, std::nan("")}) {
      CHECK(relative_error(bad, 1) == infinity);
      CHECK(relative_error(bad, pow(Exact{10}, 400)) == infinity);
    }
  }

  TEST_CASE("beyond the range of doubles the largest one is right, and the next smaller one is an ulp off") {
    const Exact beyond = pow(Exact{10}, 400);
    CHECK(relative_error(largest, beyond) == 0);
    CHECK(relative_error(-largest, -beyond) == 0);
    CHECK(relative_error(std::nextafter(largest, 0.0), beyond) == doctest::Approx(0x1p-53));
    CHECK(relative_error(-largest, beyond) == 2);
  }

  TEST_CASE("below the normal doubles an error of one spacing is allowed, and no more") {
    CHECK(relative_error(0, Exact{least} / 2) == 0);
    CHECK(relative_error(least, Exact{least} / 2) == 0);
    CHECK(relative_error(3 * least, Exact{least}) == 2);
    CHECK(relative_error(1e-310, Exact{1.001e-310}) == doctest::Approx(1e-3).epsilon(0.01));
    CHECK(relative_error(1e-307, Exact{1e-307} * (1 + Exact{1e-12})) == doctest::Approx(1e-12).epsilon(1e-3));
  }

  TEST_CASE("the reference's own logarithm, exponential, root and power have 95 right digits") {
    for (std::uint64_t index = 0; index < 40; ++index) {
      Draw draw(98, index);
      const Exact x = draw.anywhere();
      const Exact y = draw.uniform(-2000, 2000);
      CHECK(abs(detp::support::log_of(x) - log(x)) < 1e-95 * (1 + abs(log(x))));
      CHECK(abs(detp::support::exp_of(y) / exp(y) - 1) < 1e-92);
      const Exact small = draw.uniform(-0.025, 0.025);
      CHECK(abs(detp::support::log_next_to_1(small) / log(1 + small) - 1) < 1e-92);
      CHECK(abs(pow(detp::support::root_of(x), 2) / x - 1) < 1e-95);
      CHECK(abs(pow(detp::support::cube_root(x), 3) / x - 1) < 1e-95);
      CHECK(abs(detp::support::power(x, 7) / (x * x * x * x * x * x * x) - 1) < 1e-95);
    }
  }
}
