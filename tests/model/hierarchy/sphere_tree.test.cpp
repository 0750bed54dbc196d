#include "detp/model/hierarchy/sphere_tree.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "detp/model/lines/line_measure.hpp"

using namespace detp;
using doctest::Approx;
using doctest::Contains;

namespace {

const Workload in_volume = cube_workload(1e5, 1e5, 0.01, 2);
const Workload on_faces = cube_workload(1e5, 1e5, 0.01, 2, 2);

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("from the root, which holds all samples, to the leaves, spheres shrink and nodes multiply") {
    for (const Workload& w : {in_volume, on_faces})
      for (const int fan_out : {2, 3, 8, 40})
        for (const int leaf : {1, 2, 5, 12, 300}) {
          const auto levels = model::sphere_tree_levels(w, {fan_out, leaf});
          CHECK(levels.front().nodes == 1);
          CHECK(levels.front().samples == w.samples);
          CHECK(levels.back().samples == leaf);
          CHECK(levels.back().nodes == std::ceil(w.samples / leaf));
          for (std::size_t i = 0; i < levels.size(); ++i) {
            CHECK(levels[i].rms_radius >= w.disc_radius);
            if (i == 0) continue;
            CHECK(levels[i].nodes == std::ceil(w.samples / levels[i].samples));
            CHECK(levels[i].rms_radius < levels[i - 1].rms_radius);
            CHECK(levels[i].rays <= levels[i - 1].rays);
          }
        }
  }

  TEST_CASE("the counts are sums over the levels") {
    const auto levels = model::sphere_tree_levels(in_volume, {8, 12});
    const Counts<double> counts = model::sphere_tree_counts(in_volume, {8, 12});
    double nodes = 0;
    double tests = 0;
    double around = in_volume.rays;
    for (const model::TreeLevel& level : levels) {
      nodes += level.nodes;
      tests += level.nodes * around;
      around = level.rays;
    }
    CHECK(counts.culls == nodes);
    CHECK(counts.cull_tests == Approx(tests).epsilon(1e-12));
    CHECK(counts.disc_tests == in_volume.samples * around);
    CHECK(counts.sorted == in_volume.samples);
    CHECK(counts.hits == model::expected_hits(in_volume));
  }

  TEST_CASE("leaves of one sample are spheres of the disc's radius, for any dimension") {
    for (const Workload& w : {in_volume, on_faces}) {
      const double r = model::sphere_tree_levels(w, {8, 1}).back().rms_radius;
      CHECK(r == Approx(w.disc_radius).epsilon(1e-12));
    }
  }

  TEST_CASE("a leaf that holds all samples is the root, for both fan-outs") {
    const auto one = model::sphere_tree_levels(in_volume, {2, 1'000'000});
    CHECK(one.size() == 1);
    CHECK(one[0].samples == 1e5);
    CHECK(one[0].rays == model::sphere_tree_levels(in_volume, {9, 100'000})[0].rays);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("the root of many samples is nearly the sphere around their cube; of few, clearly smaller") {
    for (const double dimension : {2.0, 3.0}) {
      const Workload w = cube_workload(10, 1e5, 1e-6, 2, dimension);
      const double root = model::sphere_tree_levels(w, {2, 1'000'000})[0].rms_radius;
      CHECK(root < std::sqrt(3.0));
      CHECK(root > 0.97 * std::sqrt(3.0));
    }
  }

  TEST_CASE("spheres are half as large for eight times as many samples in a volume, four times as many on surfaces") {
    // In a volume, the mean area times n^(2/3) converges. On surfaces, the mean area times n grows with log n.
    const auto leaf_area = [](double samples, double dimension) {
      const Workload w = cube_workload(10, samples, 1e-9, 2, dimension);
      return std::pow(model::sphere_tree_levels(w, {8, 8}).back().rms_radius, 2);
    };
    CHECK(leaf_area(1e9, 3) / leaf_area(8e9, 3) == Approx(4).epsilon(0.01));
    const double first = leaf_area(1e9, 2) / 4 - leaf_area(4e9, 2);
    const double second = (leaf_area(4e9, 2) / 4 - leaf_area(16e9, 2)) * 4;
    CHECK(first < 0);
    CHECK(first == Approx(second).epsilon(0.02));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("parameters and workloads out of range are refused by name") {
    CHECK_THROWS_WITH_AS((void)model::sphere_tree_levels(in_volume, {1, 8}), Contains("fan-out"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::sphere_tree_counts(in_volume, {8, 0}), Contains("leaf"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::sphere_tree_counts(Workload{}, {8, 8}), Contains("rays"), std::invalid_argument);
  }
}
