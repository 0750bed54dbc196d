#include "detp/validate/accuracy/accuracy_check.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "detp/sim/open/open_scene.hpp"
#include "detp/validate/accuracy/judged_samples.hpp"

namespace detp::validate {
namespace {

constexpr double per_ray = 1e-6;

/// Discs with noise² = 0.2/(r² rays) and bias² = c r, radii 0.01 … 0.08; tracing and searching take 1 µs each for a ray.
AccuracyPilot made_pilot(double bias_per_radius, double bias_error = 0) {
  EstimatorPilot discs{.estimator = sim::Estimator::disc, .settings = {}, .runs = 6};
  for (const double radius : {0.01, 0.02, 0.04, 0.08})
    discs.settings.push_back({.setting = {sim::Estimator::disc, radius},
                              .scale = radius,
                              .noise_squared_times_rays = {0.2 / (radius * radius), 0},
                              .bias_squared = {bias_per_radius * radius, bias_error},
                              .mean_bias = {},
                              .seconds = {0, per_ray}});
  AccuracyPilot pilot;
  pilot.estimators = {discs};
  pilot.trace = {0, per_ray};
  pilot.photons_per_ray = 0.5;
  pilot.mean_square = 1;
  return pilot;
}

/// The pilot as if each ray took the same time in each estimator, so that its plan does not depend on the machine.
AccuracyPilot with_equal_seconds(AccuracyPilot pilot) {
  for (EstimatorPilot& one : pilot.estimators)
    for (SettingPilot& setting : one.settings) setting.seconds = {0, per_ray};
  pilot.trace = {0, per_ray};
  return pilot;
}

using Kind = AccuracyTarget::Kind;

}  // namespace

TEST_SUITE("plans of accuracy") {
  TEST_CASE("noise: the largest radius whose bias is below it, with the rays that the noise needs") {
    const AccuracyPlan plan = plan_accuracy(made_pilot(0.1), {Kind::noise, 0.05});
    CHECK(plan.reached);
    CHECK(plan.answer.noise.value == doctest::Approx(0.05).epsilon(1e-6));
    CHECK(plan.answer.radius == doctest::Approx(0.025).epsilon(0.05));  // 0.1 r = 0.05²
    CHECK(plan.answer.bias.value <= 0.05);
    CHECK(plan.answer.rays == doctest::Approx(0.2 / std::pow(plan.answer.radius * 0.05, 2)).epsilon(1e-3));
    CHECK(plan.answer.seconds == doctest::Approx(2 * per_ray * plan.answer.rays));
    CHECK(plan.answer.photons == doctest::Approx(0.5 * plan.answer.rays));
  }

  TEST_CASE("total: no other radius is faster, and noise and bias add up to the target") {
    const AccuracyPilot pilot = made_pilot(0.1);
    const AccuracyPlan plan = plan_accuracy(pilot, {Kind::total, 0.05});
    CHECK(plan.reached);
    CHECK(plan.answer.total.value == doctest::Approx(0.05).epsilon(1e-6));
    for (double radius = 0.01; radius < 0.024; radius *= 1.02) {
      const double rays = 0.2 / (radius * radius) / (0.05 * 0.05 - 0.1 * radius);
      CHECK(2 * per_ray * rays >= 0.99 * plan.answer.seconds);
    }
    CHECK(plan.answer.radius == doctest::Approx(0.0167).epsilon(0.05));  // r² (e² - c r) is largest at 2e²/3c
  }

  TEST_CASE("a total below the least bias is not reached; the plan says what gets nearest, and the floor") {
    const AccuracyPlan plan = plan_accuracy(made_pilot(1), {Kind::total, 0.05});
    CHECK_FALSE(plan.reached);
    CHECK(plan.floor == doctest::Approx(0.1));
    CHECK(plan.answer.radius == doctest::Approx(0.01));
    CHECK(plan.answer.total.value == doctest::Approx(0.1 * std::sqrt(1.05)).epsilon(1e-3));
    CHECK_FALSE(plan_accuracy(made_pilot(0), {Kind::total, 0.001}, 1e6).reached);
  }

  TEST_CASE("seconds: the most accurate setting in that time; twice the time without bias halves the square") {
    const AccuracyPlan one = plan_accuracy(made_pilot(0.1), {Kind::seconds, 0.2});
    CHECK(one.answer.seconds == doctest::Approx(0.2).epsilon(1e-3));
    for (double radius = 0.01; radius <= 0.08; radius *= 1.02)
      CHECK(std::sqrt(0.2 / (radius * radius * 1e5) + 0.1 * radius) >= 0.998 * one.answer.total.value);
    const AccuracyPlan without = plan_accuracy(made_pilot(0), {Kind::seconds, 0.2});
    const AccuracyPlan twice = plan_accuracy(made_pilot(0), {Kind::seconds, 0.4});
    CHECK(without.answer.radius == doctest::Approx(0.08));
    CHECK(twice.answer.total.value * std::sqrt(2.0) == doctest::Approx(without.answer.total.value).epsilon(1e-4));
  }

  TEST_CASE("a bias that is hardly known counts in the total: bias² 0 ± s is 0.798 s in the mean, and 1 ± 0.01 is 1") {
    for (const double error : {1e-4, 1e-2}) {
      const AccuracyPoint unknown = plan_accuracy(made_pilot(0, error), {Kind::seconds, 1}).answer;
      const double bias_squared = std::pow(unknown.total.value, 2) - std::pow(unknown.noise.value, 2);
      CHECK(bias_squared == doctest::Approx(std::sqrt(2 / std::numbers::pi) * error).epsilon(1e-6));
      CHECK(unknown.bias.value == 0);
      CHECK(unknown.total.value <= unknown.total.high);
    }
    const auto floor_of = [](double mean, double error) {
      AccuracyPilot pilot = made_pilot(0, error);
      for (SettingPilot& setting : pilot.estimators[0].settings) setting.bias_squared.mean = mean;
      return plan_accuracy(pilot, {Kind::total, 0.01}).floor;
    };
    CHECK(floor_of(0.04, 4e-4) == doctest::Approx(0.2));
    // Far below 0 the mean is s²/|mean|; both formulas meet at 6 s.
    CHECK(floor_of(-0.06 * 0.9999, 0.01) / floor_of(-0.06 * 1.0001, 0.01) == doctest::Approx(1).epsilon(0.002));
    CHECK_FALSE(plan_accuracy(made_pilot(0, 0.1), {Kind::total, 0.1}).reached);  // a bias of 0 ± 0.1 in its square
    CHECK(plan_accuracy(made_pilot(0, 1e-4), {Kind::total, 0.1}).reached);
  }

  TEST_CASE("the slope is that of the total error between two times near by, and its interval contains it") {
    AccuracyPilot pilot = made_pilot(0.1, 1e-4);
    pilot.trace.fixed = 0.01;
    const auto in = [&](double seconds) {
      AccuracyPilot one_radius = pilot;
      one_radius.estimators[0].settings.resize(1);
      return plan_accuracy(one_radius, {Kind::seconds, seconds}).answer;
    };
    for (const double seconds : {0.1, 1.0, 10.0}) {
      const AccuracyPoint before = in(seconds / 1.01);
      const AccuracyPoint after = in(seconds * 1.01);
      const double slope = std::log(after.total.value / before.total.value) / std::log(after.seconds / before.seconds);
      const AccuracyPoint point = in(seconds);
      CHECK(point.slope.value == doctest::Approx(slope).epsilon(1e-3));
      CHECK(point.slope.low <= point.slope.value);
      CHECK(point.slope.value <= point.slope.high);
    }
  }

  TEST_CASE("a point is on the frontier unless another is faster and more accurate beyond both intervals") {
    AccuracyPilot pilot = made_pilot(0.1);
    EstimatorPilot slow = pilot.estimators.front();
    slow.estimator = sim::Estimator::variable_radius;
    for (SettingPilot& setting : slow.settings) {
      setting.setting.estimator = slow.estimator;
      setting.seconds.per_ray *= 50;
    }
    pilot.estimators.push_back(slow);
    const AccuracyPlan plan = plan_accuracy(pilot, {Kind::noise, 0.05});
    CHECK(plan.answer.estimator == sim::Estimator::disc);
    REQUIRE(plan.rivals.size() == 1);
    CHECK(plan.rivals[0].seconds > 10 * plan.answer.seconds);
    int dominated = 0;
    for (const AccuracyPoint& point : plan.points) {
      if (point.estimator == sim::Estimator::disc) CHECK(point.on_frontier);
      dominated += point.on_frontier ? 0 : 1;
    }
    CHECK(dominated >= 4);
    // the same with biases that are hardly known: nothing dominates
    for (EstimatorPilot& one : pilot.estimators)
      for (SettingPilot& setting : one.settings) setting.bias_squared.standard_error = 1;
    for (const AccuracyPoint& point : plan_accuracy(pilot, {Kind::noise, 0.05}).points) CHECK(point.on_frontier);
  }

  TEST_CASE("about as fast: the one with less total error is the answer, and the other is a tie") {
    AccuracyPilot pilot = made_pilot(0);
    for (SettingPilot& setting : pilot.estimators[0].settings) setting.bias_squared.mean = 1e-4;
    EstimatorPilot other = pilot.estimators.front();
    other.estimator = sim::Estimator::area_corrected;
    for (SettingPilot& setting : other.settings) {
      setting.setting.estimator = other.estimator;
      setting.seconds.per_ray *= 1.05;
      setting.bias_squared.mean *= 0.5;
    }
    pilot.estimators.push_back(other);
    const AccuracyPlan plan = plan_accuracy(pilot, {Kind::noise, 0.04});
    CHECK(plan.answer.estimator == sim::Estimator::area_corrected);
    CHECK(plan.ties == std::vector{sim::Estimator::disc});
    for (SettingPilot& setting : pilot.estimators[1].settings) setting.seconds.per_ray *= 2;
    CHECK(plan_accuracy(pilot, {Kind::noise, 0.04}).answer.estimator == sim::Estimator::disc);
    CHECK(plan_accuracy(pilot, {Kind::noise, 0.04}).ties.empty());
  }

  TEST_CASE("no rival has less noise, less error and fewer seconds than the answer") {
    AccuracyPilot pilot = made_pilot(0.1);  // slow, with a bias below the noise
    for (SettingPilot& setting : pilot.estimators[0].settings) setting.seconds.per_ray *= 1000;
    EstimatorPilot biased = made_pilot(0).estimators.front();  // a bias just above it
    biased.estimator = sim::Estimator::area_corrected;
    for (SettingPilot& setting : biased.settings) {
      setting.setting.estimator = biased.estimator;
      setting.bias_squared.mean = std::pow(0.051, 2);
    }
    pilot.estimators.push_back(biased);
    const AccuracyPlan plan = plan_accuracy(pilot, {Kind::noise, 0.05});
    CHECK(plan.answer.estimator == sim::Estimator::area_corrected);
    CHECK(plan.answer.noise.value <= 0.05);
  }

  TEST_CASE("a check with other noise counts by its rays, and the plan ranks again") {
    const AccuracyPilot pilot = [] {
      AccuracyPilot one = made_pilot(0.1);
      one.estimators.front().noise_rays = 1e5;
      return one;
    }();
    const AccuracyPlan plan = plan_accuracy(pilot, {Kind::noise, 0.05});
    AccuracyPoint of_check = plan.answer;
    of_check.rays = 3e5;
    of_check.noise.value = 0.05;
    const AccuracyCheck check{.point = of_check, .noise = 0.1, .rays = 3e5};
    const AccuracyPlan again = plan_accuracy(with_check(pilot, check), {Kind::noise, 0.05});
    CHECK(again.answer.rays == doctest::Approx((1 + 3 * 4) / 4.0 * plan.answer.rays).epsilon(1e-6));
  }

  TEST_CASE("what few photons bring is weak") {
    AccuracyPilot pilot = made_pilot(0.1);
    CHECK_FALSE(plan_accuracy(pilot, {Kind::noise, 0.05}).answer.noise_weak);
    for (SettingPilot& setting : pilot.estimators[0].settings) setting.rare_photons = 10;
    const AccuracyPoint weak = plan_accuracy(pilot, {Kind::noise, 0.05}).answer;
    CHECK(weak.noise_weak);
    CHECK(weak.noise.high > 1.5 * weak.noise.value);
  }

  TEST_CASE("seconds of neighbours grow with the square of the rays; the rays in a time are found again") {
    const GrowingSeconds seconds{0.1, 1e-6, 1e-12};
    CHECK(seconds.at(1e6) == doctest::Approx(2.1));
    CHECK(seconds.rays_in(2.1) == doctest::Approx(1e6));
    CHECK(seconds.rays_in(0.05) == 1);
    CHECK(GrowingSeconds{0, 1e-6}.rays_in(2) == doctest::Approx(2e6));
  }

  TEST_CASE("@furnace: noise and time of the answer come true, and discs are found to lose light at edges") {
    sim::Scene furnace = sim::open_scene({.name = "@furnace", .samples = {}});
    const AccuracyPilotOptions options{
        .estimators = {sim::Estimator::disc, sim::Estimator::triangle_hits},
    };
    PilotMaker maker(furnace, options);
    const AccuracyPilot pilot = with_equal_seconds(maker.make({200'000, maker.first_paths()}));
    CHECK(pilot.mean_square == doctest::Approx(std::pow(6.2832, 2)).epsilon(0.03));
    for (const SettingPilot& setting : pilot.estimators[0].settings)
      CHECK(setting.bias_squared.mean > 3 * setting.bias_squared.standard_error);
    const AccuracyPlan plan = plan_accuracy(pilot, {Kind::noise, 0.1});
    const AccuracyCheck check = check_accuracy(furnace, plan.answer, pilot.mean_square, options);
    CHECK(check.noise == doctest::Approx(0.1).epsilon(0.15));
    CHECK_FALSE(check.error.has_value());
    CHECK(plan.answer.estimator == sim::Estimator::triangle_hits);
  }
}

TEST_SUITE("plans of accuracy") {
  TEST_CASE("the seconds of a further pilot do not depend on the paths of a reference that is given") {
    sim::Scene furnace = sim::open_scene({.name = "@furnace", .samples = {}});
    const Reference known = make_reference(furnace, {.samples = 200});
    Reference by_paths = known;
    by_paths.paths = 1 << 20;
    const auto next = [&](const Reference& reference) {
      PilotMaker maker(furnace, {.estimators = {sim::Estimator::disc}, .reference = &reference});
      const AccuracyPilot first = maker.make({4000, 16});
      return maker.predicted_seconds({16'000, 16}, &first);
    };
    CHECK(next(by_paths) == next(known));
    CHECK(next(by_paths) < 1);
  }
}

TEST_SUITE("long") {
  TEST_CASE("with a reference: noise of other runs is inside its interval in at least 52 of 60, the error in its own") {
    for (const char* name : {"@furnace", "@cornell"}) {
      CAPTURE(name);
      sim::Scene scene = sim::open_scene({.name = name, .samples = {}});
      const Reference reference = make_reference(scene, {.samples = 500, .error = 0.03});
      const AccuracyPilotOptions options{.estimators = {sim::Estimator::disc, sim::Estimator::triangle_hits},
                                         .reference = &reference};
      PilotMaker maker(scene, options);
      const AccuracyPilot pilot = with_equal_seconds(maker.make({100'000, maker.first_paths()}));
      const AccuracyPoint answer = plan_accuracy(pilot, {Kind::total, 0.2}).answer;
      CHECK(answer.noise.low < answer.noise.value);
      CHECK(answer.noise.value < answer.noise.high);
      const AccuracyCheck check = check_accuracy(scene, answer, pilot.mean_square, options);
      CHECK(check.error.value() > 0.7 * answer.total.low);
      CHECK(check.error.value() < 1.3 * answer.total.high);
      const auto runs = rerun_accuracy(scene, answer, pilot.mean_square, {1, 60}, options);
      REQUIRE(runs.size() == 60);
      CHECK(std::ranges::count_if(runs, [&](const AccuracyRerun& one) {
              return one.noise > answer.noise.low && one.noise < answer.noise.high;
            }) >= 52);
      CHECK(runs.front().seed == 1);
      CHECK(runs.back().seed == 60);
    }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the first half of the photons and all of them have the light of the same photons") {
    sim::Scene cornell = sim::open_scene({.name = "@cornell", .samples = {}});
    ReplicateMaker maker(cornell, false, 1);
    const sim::Paths paths = maker.trace(2000, 1, 0);
    const sim::PathRays half = first_photons(paths, paths.photon_count / 2);
    CHECK(half.photon_count == paths.photon_count / 2);
    REQUIRE(half.rays.size() > 0);
    CHECK(half.photons.back() < half.photon_count);
    CHECK(paths.photons[half.rays.size()] >= half.photon_count);  // no photon is cut in two
    CHECK(first_photons(paths, paths.photon_count).rays.size() == paths.rays.size());
  }

  TEST_CASE("area weights add up to 1, and those of a furnished mesh follow its triangles") {
    const sim::Scene cornell = sim::open_scene({.name = "@cornell", .samples = {}});
    const std::vector<double> weights = area_weights(cornell);
    CHECK(weights.size() == cornell.samples.size());
    CHECK(std::accumulate(weights.begin(), weights.end(), 0.0) == doctest::Approx(1).epsilon(1e-12));
    const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
    CHECK(*least > 0);
    CHECK(*most > 3 * *least);  // a corner has one or two triangles, the inside six
    const std::vector<double> equal = area_weights(sim::open_scene({.name = "@cornell", .samples = 6000}));
    CHECK(equal.front() == doctest::Approx(1.0 / 6000));
    CHECK(mirror_share(cornell.mesh) == 0);
    CHECK(mirror_notice(0).empty());
  }

  TEST_CASE("mirrors and glass do not count, unless they are asked for or there is nothing else") {
    for (const std::optional<std::size_t> samples :
         {std::optional<std::size_t>(), std::optional<std::size_t>(20'000)}) {
      sim::Scene scene = sim::open_scene({.name = "@caustic", .samples = samples});
      const double share = mirror_share(scene.mesh);
      CHECK(share > 0.05);
      CHECK(share < 0.5);
      const std::vector<double> all = area_weights(scene, Surfaces::all);
      const std::vector<double> weights = area_weights(scene);
      double left = 0;  // of the area of all
      for (std::size_t i = 0; i < weights.size(); ++i) left += weights[i] > 0 ? all[i] : 0;
      if (!samples) CHECK(left == doctest::Approx(1 - share).epsilon(0.05));
      CHECK(left < 1);  // more samples than vertices are not spread by area: glass has more vertices
      CHECK(left > 0.5);
      CHECK(std::accumulate(weights.begin(), weights.end(), 0.0) == doctest::Approx(1).epsilon(1e-12));
      for (sim::Material& one : scene.mesh.materials.all) one.diffuse = 0, one.specular = 1, one.glass = 0;
      CHECK(area_weights(scene) == all);
    }
  }

  TEST_CASE("a rehearsal knows the noise of runs, also of variable-radius, which a short pilot does not" *
            doctest::test_suite("long")) {
    sim::Scene scene = sim::open_scene({.name = "@cornell", .samples = {}});
    constexpr double rays = 1e5;
    constexpr double radius = 0.03;
    for (const auto estimator :
         {sim::Estimator::disc, sim::Estimator::variable_radius, sim::Estimator::triangle_hits}) {
      CAPTURE(name(estimator));
      const AccuracyPilotOptions options{.estimators = {estimator}, .radii = {radius}};
      PilotMaker maker(scene, options);
      AccuracyPilot pilot = maker.make({4000, 16});
      const AccuracySetting setting{estimator, uses_radius(estimator) ? radius : 0};
      const double scale = uses_radius(estimator) ? radius : 1;
      CHECK_FALSE(maker.rehearsal_size(pilot, setting, 1000, 10));  // fewer rays than the pilot
      const auto size = maker.rehearsal_size(pilot, setting, rays / 2, 10);
      REQUIRE(size);
      CHECK(size->samples == scene.samples.size());
      maker.rehearse(pilot, setting, *size, rays);
      CHECK(pilot.estimators.front().rehearsed == scale);
      const double promised = std::sqrt(pilot.estimators.front().noise_squared(scale, rays));
      const AccuracyPoint point{.estimator = estimator, .rays = rays, .radius = setting.radius};
      double square = 0;
      const auto runs = rerun_accuracy(scene, point, pilot.mean_square, {1, 8}, options);
      for (const AccuracyRerun& run : runs) square += run.noise * run.noise / static_cast<double>(runs.size());
      CHECK(std::sqrt(square) == doctest::Approx(promised).epsilon(0.05));
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("targets and numbers of rays out of range, and scenes without light on the samples are refused") {
    const AccuracyPilot pilot = made_pilot(0.1);
    CHECK_THROWS_AS((void)plan_accuracy(pilot, {Kind::noise, 0}), std::invalid_argument);
    CHECK_THROWS_AS((void)plan_accuracy(pilot, {Kind::total, 1.5}), std::invalid_argument);
    CHECK_THROWS_AS((void)plan_accuracy(pilot, {Kind::seconds, -1}), std::invalid_argument);
    CHECK_THROWS_AS((void)plan_accuracy(pilot, {Kind::noise, 0.1}, 0), std::invalid_argument);
    sim::Scene uniform = sim::open_scene({.name = "@uniform", .samples = 100});
    CHECK_THROWS_AS(PilotMaker(uniform, {}), std::invalid_argument);
  }
}

}  // namespace detp::validate
