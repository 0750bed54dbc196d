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
