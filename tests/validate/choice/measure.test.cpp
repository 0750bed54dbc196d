#include "detp/validate/choice/measure.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/open/uniform_discs.hpp"

using namespace detp;

TEST_SUITE("known answer") {
  TEST_CASE("the dimension of uniform samples is that of their body, to 0.1") {
    CHECK(std::abs(validate::sample_dimension(sim::uniform_discs(sim::Body::cube, 2, 100'000, 0.01, 1)) - 3) < 0.1);
    CHECK(std::abs(validate::sample_dimension(sim::uniform_discs(sim::Body::cube_faces, 2, 100'000, 0.01, 1)) - 2) <
          0.1);
  }

  TEST_CASE("points on a line have dimension 1; a few points count as a volume") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 50'000, 0.01, 1);
    for (sim::Disc& disc : discs) disc.centre.y = disc.centre.z = 0;
    CHECK(std::abs(validate::sample_dimension(discs) - 1) < 0.1);
    CHECK(validate::sample_dimension(std::span(discs).first(100)) == 3);
  }

  TEST_CASE("a workload has the scene's counts, box, sphere, root mean square radius, length inside the box") {
    const std::vector<sim::Disc> discs{{.centre = {0, 0, 0}, .radius = 1}, {.centre = {10, 4, 2}, .radius = 7}};
    const std::vector<sim::Ray> rays{{.origin = {5, 2, 1}, .direction = {1, 0, 0}, .length = 3},
                                     {.origin = {5, 2, 1}, .direction = {1, 0, 0}, .length = 300},
                                     {.origin = {500, 2, 1}, .direction = {1, 0, 0}, .length = 3}};
    const Workload w = validate::measure(sim::make_problem(rays, discs));
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
    CHECK(validate::measure(sim::make_problem(rays, discs)).radii.empty());
    for (std::size_t i = 0; i < 1000; i += 10) discs[i].radius = 0.25;
    const Workload w = validate::measure(sim::make_problem(rays, discs));
    REQUIRE(w.radii.size() == 2);
    CHECK(w.radii[0].radius == doctest::Approx(0.25));
    CHECK(w.radii[0].share == doctest::Approx(0.1));
    CHECK_NOTHROW(check(w));
  }

  TEST_CASE("a few discs far away do not count among the central samples") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 10'000, 0.02, 1);
    for (std::size_t i = 0; i < 3; ++i) discs[i].centre *= 1000;
    const std::vector<sim::Ray> lines = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 10);
    const Workload w = validate::measure(sim::make_problem(lines, discs));
    REQUIRE(w.central);
    CHECK_NOTHROW(check(w));
    CHECK(w.samples == 10'000);
    CHECK(w.central->samples == 9997);
    for (const double side : w.central->box) CHECK(side == doctest::Approx(2).epsilon(0.001));
    CHECK(w.central->sample_extent == doctest::Approx(8).epsilon(0.01));
    CHECK(w.central->ray_share == doctest::Approx(std::pow(w.central->sphere_radius / w.sphere_radius, 2)));
    CHECK(w.central->path_length == 0);
    const std::vector<sim::Ray> segments{{.origin = {0, 0, 0}, .direction = {1, 0, 0}, .length = 0.5},
                                         {.origin = {100, 100, 100}, .direction = {1, 0, 0}, .length = 0.5}};
    const auto central = validate::measure(sim::make_problem(segments, discs)).central;
    REQUIRE(central);
    CHECK(central->ray_share == 0.5);
    CHECK(central->path_length == doctest::Approx(0.5));
  }

  TEST_CASE("a workload records whether only fronts count") {
    const std::vector<sim::Disc> discs{{}};
    const std::vector<sim::Ray> rays{{}};
    CHECK_FALSE(validate::measure(sim::make_problem(rays, discs)).front_facing);
    CHECK(validate::measure(sim::make_problem(rays, discs, true)).front_facing);
  }

  TEST_CASE("unbounded lines have no path length") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 100, 0.01, 1);
    const auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 10);
    CHECK(validate::measure(sim::make_problem(rays, discs)).path_length == 0);
  }

  TEST_CASE("a single sample is a valid workload") {
    const std::vector<sim::Disc> discs{{}};
    const std::vector<sim::Ray> rays{{}};
    CHECK_NOTHROW(check(validate::measure(sim::make_problem(rays, discs))));
  }

  TEST_CASE("a mesh's area becomes the samples' extent, and its mean edge their distance") {
    const auto discs = sim::uniform_discs(sim::Body::cube_faces, 2, 50'000, 0.01, 1);
    const std::vector<sim::Ray> rays{{}};
    const Workload w = validate::measure(sim::make_problem(rays, discs), {.area = 24, .edge_length = 0.03});
    CHECK(sample_distance(w) == 0.03);
    const double weight = w.dimension - 2;  // of the box's volume; the area has 1 - weight
    CHECK(sample_extent(w) == doctest::Approx(std::pow(8, weight) * std::pow(24, 1 - weight)).epsilon(1e-3));
  }
}
