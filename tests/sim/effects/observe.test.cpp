#include "detp/sim/effects/observe.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"

using namespace detp;

TEST_SUITE("known answer") {
  TEST_CASE("a workload has the scene's counts, box, sphere, root mean square radius, length inside the box") {
    const std::vector<sim::Disc> discs{{.centre = {0, 0, 0}, .radius = 1}, {.centre = {10, 4, 2}, .radius = 7}};
    const std::vector<sim::Ray> rays{{.origin = {5, 2, 1}, .direction = {1, 0, 0}, .length = 3},
                                     {.origin = {5, 2, 1}, .direction = {1, 0, 0}, .length = 300},
                                     {.origin = {500, 2, 1}, .direction = {1, 0, 0}, .length = 3}};
    const Workload w = sim::observe(sim::make_problem(rays, discs), {}, sim::EffectSelection("all")).workload;
    CHECK(w.rays == 3);
    CHECK(w.samples == 2);
    CHECK(w.disc_radius == 5);
    CHECK(w.box == std::array<double, 3>{10, 4, 2});
    CHECK(w.sphere_radius == doctest::Approx(std::sqrt(30.0) + 7));
    CHECK(w.path_length == doctest::Approx((3 + 10 + 0) / 3.0));  // the box ends at 10 + 5
  }

  TEST_CASE("radii that differ by more than a tenth become classes; equal and almost equal ones do not") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 1000, 0.02, 1);
    const std::vector<sim::Ray> rays{{}};
    for (std::size_t i = 0; i < 1000; i += 2) discs[i].radius = 0.021;
    CHECK(sim::observe(sim::make_problem(rays, discs)).workload.radii.empty());
    for (std::size_t i = 0; i < 1000; i += 10) discs[i].radius = 0.25;
    const Workload w = sim::observe(sim::make_problem(rays, discs)).workload;
    REQUIRE(w.radii.size() == 2);
    CHECK(w.radii[0].radius == doctest::Approx(0.25));
    CHECK(w.radii[0].share == doctest::Approx(0.1));
    CHECK_NOTHROW(check(w));
  }

  TEST_CASE("a workload records whether only fronts count") {
    const std::vector<sim::Disc> discs{{}};
    const std::vector<sim::Ray> rays{{}};
    CHECK_FALSE(sim::observe(sim::make_problem(rays, discs)).workload.front_facing);
    CHECK(sim::observe(sim::make_problem(rays, discs, true)).workload.front_facing);
  }

  TEST_CASE("unbounded lines have no path length") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 100, 0.01, 1);
    const auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 10);
    CHECK(sim::observe(sim::make_problem(rays, discs)).workload.path_length == 0);
  }

  TEST_CASE("a single sample is a valid workload") {
    const std::vector<sim::Disc> discs{{}};
    const std::vector<sim::Ray> rays{{}};
    CHECK_NOTHROW(check(sim::observe(sim::make_problem(rays, discs)).workload));
  }

  TEST_CASE("a mesh's area becomes the samples' extent, and its mean edge their distance") {
    const auto discs = sim::uniform_discs(sim::Body::cube_faces, 2, 50'000, 0.01, 1);
    const std::vector<sim::Ray> rays{{}};
    const Workload w = sim::observe(sim::make_problem(rays, discs), {.area = 24, .edge_length = 0.03}).workload;
    CHECK(sample_distance(w) == 0.03);
    const double weight = w.dimension - 2;  // of the box's volume; the area has 1 - weight
    CHECK(sample_extent(w) == doctest::Approx(std::pow(8, weight) * std::pow(24, 1 - weight)).epsilon(1e-3));
  }
}

namespace {

const sim::EffectReport& report_of(const sim::Observed& observed, const sim::Effect& effect) {
  for (const sim::EffectReport& report : observed.effects)
    if (report.effect == &effect) return report;
  throw std::logic_error("no report");
}

/// Segments from the faces of a cube of side 2 inwards, half as long as its side, and discs on the faces.
struct Room {
  std::vector<sim::Disc> discs = sim::uniform_discs(sim::Body::cube_faces, 2, 20'000, 0.01, 1);
  std::vector<sim::Ray> rays;

  Room() {
    for (std::size_t i = 0; i < 1000; ++i) {
      const glm::dvec3 to_centre = -glm::normalize(discs[i].centre);
      rays.push_back({.origin = discs[i].centre, .direction = to_centre, .length = 1});
    }
  }
};

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("uniform lines and samples in a volume call for no effect; the workload is the plain one, bit for bit") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.01, 1);
    const auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 5000);
    const sim::Problem problem = sim::make_problem(rays, discs);
    const sim::Observed automatic = sim::observe(problem);
    for (const sim::EffectReport& report : automatic.effects) CHECK_FALSE(report.on);
    const Workload none = sim::observe(problem, {}, sim::EffectSelection("none")).workload;
    CHECK(automatic.workload.dimension == 3);
    CHECK(automatic.workload.sample_extent == 0);
    CHECK(automatic.workload.path_length == 0);
    CHECK_FALSE(automatic.workload.rays_end);
    CHECK(sample_distance(automatic.workload) == sample_distance(none));
    CHECK(automatic.workload.box == none.box);
  }

  TEST_CASE("segments and samples on surfaces are found; with none on, segments still cost more") {
    const Room room;
    const sim::Problem problem = sim::make_problem(room.rays, room.discs);
    const sim::Observed found = sim::observe(problem);
    CHECK(report_of(found, sim::finite_paths).on);
    CHECK(report_of(found, sim::surface_samples).on);
    CHECK(found.workload.path_length == doctest::Approx(1).epsilon(0.02));
    CHECK(found.workload.dimension < 2.3);
    const sim::Observed none = sim::observe(problem, {}, sim::EffectSelection("none"));
    CHECK(none.workload.path_length == 0);
    CHECK(none.workload.dimension == 3);
    CHECK(some_rays_end(none.workload));
    CHECK(report_of(none, sim::finite_paths).value == report_of(found, sim::finite_paths).value);
  }

  TEST_CASE("meanings of the input need no evidence, and are those of no effects") {
    Room room;
    for (std::size_t i = 0; i < room.discs.size(); i += 2) room.discs[i].radius *= 2;
    const sim::Problem problem = sim::make_problem(room.rays, room.discs, true);
    const Workload alone = sim::with_inputs_alone(problem);
    const Workload none = sim::observe(problem, {}, sim::EffectSelection("none")).workload;
    CHECK(alone.front_facing);
    CHECK(alone.radii.size() == 2);
    CHECK(alone.radii.size() == none.radii.size());
    CHECK(alone.dimension == none.dimension);
    CHECK(alone.path_length == none.path_length);
    CHECK(alone.rays_end == none.rays_end);
  }

  TEST_CASE("segments as long as lines call for no effect") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.01, 1);
    auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 20'000);
    for (sim::Ray& ray : rays) {
      ray.origin -= 4.0 * ray.direction;
      ray.length = 8;
    }
    const sim::Observed found = sim::observe(sim::make_problem(rays, discs));
    const sim::EffectReport& report = report_of(found, sim::finite_paths);
    CHECK_FALSE(report.on);
    CHECK(std::abs(report.value - 1) < 4 * report.standard_error);
    CHECK(found.workload.path_length == 0);
    CHECK(some_rays_end(found.workload));
  }

  TEST_CASE("a list switches the effects that it names on and the others off, but not what the input means") {
    const Room room;
    const sim::Problem problem = sim::make_problem(room.rays, room.discs, true);
    const sim::Observed one = sim::observe(problem, {}, sim::EffectSelection("surface-samples"));
    CHECK_FALSE(report_of(one, sim::finite_paths).on);
    CHECK(report_of(one, sim::surface_samples).on);
    CHECK(report_of(one, sim::one_face).on);
    CHECK(one.workload.front_facing);
    CHECK(report_of(one, sim::finite_paths).reason == "switched off by --effects surface-samples");
    const sim::Observed all = sim::observe(problem, {}, sim::EffectSelection("all"));
    CHECK_FALSE(report_of(all, sim::mixed_radii).on);
    CHECK_NOTHROW(check(all.workload));
  }

  TEST_CASE("a selection reads what it writes; unknown names and meanings of the input are refused") {
    for (const char* text : {"auto", "none", "all", "finite-paths", "uneven-rays,surface-samples"})
      CHECK(sim::EffectSelection(text).text() == text);
    CHECK(sim::EffectSelection("finite paths").text() == "finite-paths");
    CHECK_THROWS_WITH_AS(sim::EffectSelection("fog"),
                         "there is no effect \"fog\"; there are auto, none, all, or a list of surface-samples, "
                         "clustered-samples, concave-surfaces, finite-paths, uneven-rays, occlusion, directional-bias",
                         std::invalid_argument);
    for (const char* bad : {"", ",", "finite-paths,", "all,none", "Auto"})
      CHECK_THROWS_AS(sim::EffectSelection{bad}, std::invalid_argument);
    CHECK_THROWS_WITH_AS(sim::EffectSelection("facing"),
                         "the effect \"facing\" is a meaning of the input; it cannot be switched",
                         std::invalid_argument);
  }

  TEST_CASE("the reason says where the value lies, and whether it is close to the threshold") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 5000, 0.01, 1);
    auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 2000);
    for (sim::Ray& ray : rays) {
      ray.origin -= 4.0 * ray.direction;
      ray.length = 8;
    }
    const sim::Observed found = sim::observe(sim::make_problem(rays, discs));
    const sim::EffectReport& paths = report_of(found, sim::finite_paths);  // its standard error is near the tolerance
    CHECK(paths.is_close());
    CHECK(paths.reason.ends_with("; close to its threshold"));
  }

  TEST_CASE("samples in small clusters have small boxes around them; uniform ones the boxes of uniform samples") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 50'000, 0.01, 1);
    const auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 100);
    const sim::Observed uniform = sim::observe(sim::make_problem(rays, discs), {}, sim::EffectSelection("all"));
    CHECK(std::abs(report_of(uniform, sim::clustered_samples).value - 1) < 0.1);
    const auto& nodes = uniform.workload.nodes;
    REQUIRE(nodes.size() > 2);
    CHECK(nodes.front().samples == doctest::Approx(50'000));
    CHECK(nodes.front().surface[0] == doctest::Approx(24).epsilon(0.01));
    CHECK(nodes.front().volume[0] == doctest::Approx(8).epsilon(0.01));
    CHECK(nodes.back().samples == 1);
    CHECK(nodes.back().squares[2] == doctest::Approx(8).epsilon(1e-9));  // 4 Σ (1 - n_i²)
    CHECK_NOTHROW(check(uniform.workload));
    for (std::size_t i = 0; i < discs.size(); ++i) {  // eight clusters of a tenth of the side
      const int corner = static_cast<int>(i % 8);
      discs[i].centre = 0.1 * discs[i].centre + glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2);
    }
    const sim::Observed clusters = sim::observe(sim::make_problem(rays, discs));
    CHECK(report_of(clusters, sim::clustered_samples).on);
    CHECK(report_of(clusters, sim::clustered_samples).value < 0.2);
    const auto eighth = std::find_if(clusters.workload.nodes.begin(), clusters.workload.nodes.end(),
                                     [](const NodeBoxes& one) { return one.samples < 10'000; });
    REQUIRE(eighth != clusters.workload.nodes.end());
    CHECK(eighth->surface[0] == doctest::Approx(0.24).epsilon(0.02));
  }

  TEST_CASE("parallel rays hit the discs that face them twice as often as isotropic rays") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.01, 1);
    for (sim::Disc& disc : discs) disc.normal = {0, 0, 1};
    std::vector<sim::Ray> rays;
    for (const sim::Disc& disc : sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.01, 2))
      rays.push_back({.origin = {disc.centre.x, disc.centre.y, -2}, .direction = {0, 0, 1}, .length = 4});
    const sim::Observed found = sim::observe(sim::make_problem(rays, discs));
    const Workload& w = found.workload;
    const double density = report_of(found, sim::uneven_rays).value;
    CHECK(density == doctest::Approx(1).epsilon(0.25));
    CHECK(w.hit_ratio == doctest::Approx(2).epsilon(0.25));
  }

  TEST_CASE("rays that pass only the emptier half of the samples are less dense around the samples") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.01, 1);
    for (std::size_t i = 0; i < discs.size(); ++i)
      if (i % 10 != 0) discs[i].centre.x = -std::abs(discs[i].centre.x);  // 95 % of the samples
    std::vector<sim::Ray> rays;
    for (const sim::Disc& disc : sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.01, 2))
      rays.push_back({.origin = {std::abs(disc.centre.x), disc.centre.y, -2}, .direction = {0, 0, 1}, .length = 4});
    const sim::Observed found = sim::observe(sim::make_problem(rays, discs));
    const sim::EffectReport& report = report_of(found, sim::uneven_rays);
    CHECK(report.on);
    CHECK(report.value < 0.5);
    CHECK(found.workload.ray_density == report.value);
  }

  TEST_CASE("clusters that no sampled ray met do not make the density of rays certain") {
    // Nearly all samples are in one cluster, which one or two of the sampled rays meet, or none; the rays are uniform.
    constexpr int seeds = 30;
    int wrong = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      auto discs = sim::uniform_discs(sim::Body::cube, 2, 2000, 0.01, 1);
      for (std::size_t i = 0; i < discs.size(); ++i)
        if (i % 20 != 0) discs[i].centre = 0.01 * discs[i].centre + glm::dvec3(0.5, 0.3, 0.4);
      std::vector<sim::Ray> rays = sim::LineField(sim::enclosing_sphere(discs), seed).lines(0, 2000);
      const auto origins = sim::uniform_discs(sim::Body::cube, 2, rays.size(), 0.01, 100 + seed);
      for (std::size_t i = 0; i < origins.size(); ++i)
        rays[i] = {.origin = origins[i].centre, .direction = rays[i].direction, .length = 0.2};
      const sim::EffectReport density = report_of(sim::observe(sim::make_problem(rays, discs)), sim::uneven_rays);
      wrong += std::abs(density.value - 1) > 2.5 * density.standard_error ? 1 : 0;
    }
    CHECK(wrong <= 2);
  }

  TEST_CASE("where no ray was met near a sample, directional bias is unknown, not certainly 1") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 1000, 1e-6, 1);
    const sim::Ray away{.origin = {0, 0, 5}, .direction = {0, 0, 1}, .length = 1};
    const sim::Observed none = sim::observe(sim::make_problem(std::vector<sim::Ray>(100, away), discs));
    CHECK_FALSE(report_of(none, sim::directional_bias).on);
    CHECK(report_of(none, sim::directional_bias).value == 1);
    CHECK(report_of(none, sim::directional_bias).standard_error == doctest::Approx(0.5));
  }

  TEST_CASE("rays that graze all discs show that fewer hit, with an error for what was not met") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 5000, 0.01, 1);
    for (sim::Disc& disc : discs) disc.normal = {0, 0, 1};
    std::vector<sim::Ray> rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 5000);
    for (sim::Ray& ray : rays) ray.direction = glm::normalize(glm::dvec3(ray.direction.x, ray.direction.y, 1e-9));
    const sim::Observed found = sim::observe(sim::make_problem(rays, discs));
    CHECK(report_of(found, sim::directional_bias).value < 0.3);
    CHECK(report_of(found, sim::directional_bias).standard_error > 0);
    CHECK(report_of(found, sim::directional_bias).on);
  }

  TEST_CASE("the effort of evidence follows the length of the search, and a small one samples less") {
    const auto short_search = sim::EvidenceEffort::for_search(1e3, 1e3);
    const auto long_search = sim::EvidenceEffort::for_search(1e7, 1e6);
    CHECK(long_search.discs == 8192);
    CHECK(long_search.rays == 2048);
    CHECK(long_search.crossing_rays == 512);
    CHECK(short_search.discs < 0.2 * 8192);
    CHECK(short_search.discs >= 1024);  // the least for a dimension
    CHECK(short_search.crossing_rays < 0.2 * 512);
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.01, 1);
    const auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 5000);
    const sim::Problem problem = sim::make_problem(rays, discs);
    const sim::Observed few = sim::observe(problem, {}, {}, {}, short_search);
    CHECK(few.discs == short_search.discs);
    CHECK(few.rays == short_search.rays);
    for (const sim::EffectReport& report : few.effects) CHECK_FALSE(report.on);
    CHECK(report_of(few, sim::uneven_rays).standard_error >
          report_of(sim::observe(problem), sim::uneven_rays).standard_error);
  }

  TEST_CASE("samples in the shade make fewer hits than the rays around them; lines are not stopped") {
    // light from above falls on a roof; half of the samples are close below it
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.01, 1);
    for (std::size_t i = 0; i < discs.size(); ++i) {
      discs[i].normal = {0, 0, 1};
      discs[i].centre.z = i % 2 == 0 ? 0.0 : -0.04;
    }
    discs[0].centre.z = 1;
    discs[1].centre.z = -1;
    std::vector<sim::Ray> rays;
    for (const sim::Disc& disc : sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.01, 2))
      rays.push_back({.origin = {disc.centre.x, disc.centre.y, 1}, .direction = {0, 0, -1}, .length = 1.001});
    const sim::Observed found = sim::observe(sim::make_problem(rays, discs));
    const sim::EffectReport& shade = report_of(found, sim::occlusion);
    CHECK(shade.on);
    CHECK(shade.value < 0.8);
    CHECK(found.workload.hit_ratio ==
          doctest::Approx(shade.value * report_of(found, sim::directional_bias).value).epsilon(1e-12));
    for (sim::Ray& ray : rays) ray.length = sim::unbounded;
    const sim::Observed lines = sim::observe(sim::make_problem(rays, discs));
    CHECK_FALSE(report_of(lines, sim::occlusion).on);
    CHECK(report_of(lines, sim::occlusion).value == 1);
  }
}
