#include "detp/model/hierarchy/cell_spheres.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

#include "detp/model/hierarchy/sphere_tree.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/sim/geometry/random.hpp"

using namespace detp;
using doctest::Approx;
using doctest::Contains;

namespace {

const Workload workload = cube_workload(1e5, 1e4, 0.01, 2);

const Workload in_volume = cube_workload(1e5, 1e5, 0.01, 2);
const Workload on_faces = cube_workload(1e5, 1e5, 0.01, 2, 2);

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a child's sphere touches its parent's from inside") {
    for (int level = 0; level < 20; ++level) {
      const double outer = model::cell_sphere_radius(workload, level);
      const double inner = model::cell_sphere_radius(workload, level + 1);
      const double between = std::ldexp(2.0, -level - 1) * std::sqrt(0.75);  // distance of the centres
      CHECK(between + inner == doctest::Approx(outer).epsilon(1e-15));
    }
  }

  TEST_CASE("without levels every ray is tested against every disc; with levels the counts are the levels' sums") {
    const Counts<double> none = model::cell_sphere_counts(workload, {0});
    CHECK(none.disc_tests == workload.rays * workload.samples);
    CHECK(none.cull_tests == 0);
    const Counts<double> one = model::cell_sphere_counts(workload, {1});
    CHECK(one.cull_tests == doctest::Approx(8 * workload.rays).epsilon(1e-12));
    const double share = model::cell_sphere_radius(workload, 1) / workload.sphere_radius;
    CHECK(one.disc_tests == doctest::Approx(workload.samples * workload.rays * share * share).epsilon(1e-12));
  }

  TEST_CASE("depths are counted one after the other until the visit returns false") {
    int depth = 0;
    model::for_each_cell_sphere_depth(workload, {9}, [&](const Counts<double>& counts) {
      CHECK(counts == model::cell_sphere_counts(workload, {depth}));
      return ++depth < 5;
    });
    CHECK(depth == 5);
  }

  TEST_CASE("in a cube, the workload's cells are those of the formula; the unit of length does not matter") {
    for (const int level : {0, 1, 3, 8, 16, 40, 300})
      CHECK(model::occupied_cell_spheres(workload, level) == model::occupied_cell_spheres(1e4, level));
    Workload box = workload;
    box.box = {2, 1.3, 0.7};
    for (const double dimension : {2.0, 2.4, 3.0})
      for (const int level : {1, 2, 5, 9}) {
        box.dimension = dimension;
        Workload scaled = box;
        for (double& side : scaled.box) side *= 3e-7;
        scaled.sphere_radius *= 3e-7;
        scaled.disc_radius *= 3e-7;
        CHECK(model::occupied_cell_spheres(scaled, level) ==
              doctest::Approx(model::occupied_cell_spheres(box, level)).epsilon(1e-9));
      }
  }

  TEST_CASE("cells grow with the level and the samples, and are at most all cells and at most the samples") {
    for (const double dimension : {2.0, 2.5, 3.0})
      for (const double extent : {0.0, 1.7}) {
        Workload w = workload;
        w.dimension = dimension;
        w.sample_extent = extent;
        double last = 1;
        for (int level = 1; level <= 40; ++level) {
          const double cells = model::occupied_cell_spheres(w, level);
          CHECK(cells >= last * (1 - 1e-12));
          CHECK(cells <= std::min(std::ldexp(1.0, 3 * level), 1e4) * (1 + 1e-12));
          last = cells;
        }
        CHECK(last == doctest::Approx(1e4).epsilon(1e-6));
      }
  }

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
  TEST_CASE("many samples on a cube's faces fill the cells at its surface; in a flat box, those at its sides") {
    const Workload faces = cube_workload(10, 1e15, 0.01, 2, 2);
    for (const int level : {1, 2, 5}) {
      const double along = std::ldexp(1.0, level);
      CHECK(model::occupied_cell_spheres(faces, level) ==
            doctest::Approx(along * along * along - std::pow(along - 2, 3)).epsilon(1e-12));
    }
    Workload flat = cube_workload(10, 1e15, 0.01, 2);
    flat.box = {2, 0.9, 0};
    CHECK(model::occupied_cell_spheres(flat, 3) == doctest::Approx(8 * 4));  // 0.9 ends inside a cell of 0.25
    flat.dimension = 2;
    CHECK(model::occupied_cell_spheres(flat, 3) == doctest::Approx(8 * 4));
  }

  TEST_CASE("agrees with cells counted on random samples in a box that cuts cells, and on its faces") {
    constexpr int samples = 20'000;
    for (const double dimension : {2.0, 3.0})
      for (const int level : {2, 4, 6}) {
        Workload w = cube_workload(10, samples, 0.01, 2, dimension);
        w.box = {2, 1.1, 0.6};
        std::set<std::uint64_t> cells;
        for (std::uint64_t i = 0; i < samples; ++i) {
          const auto u = sim::uniform4(23, sim::Stream::tests, i);
          std::array<double, 3> place{u[0], u[1], u[2]};
          const double pick = u[3] * (1.1 * 0.6 + 2 * 0.6 + 2 * 1.1);
          const std::size_t across = pick < 1.1 * 0.6 ? 0 : (pick < 1.1 * 0.6 + 2 * 0.6 ? 1 : 2);
          if (dimension == 2) place[across] = place[across] < 0.5 ? 0 : std::nextafter(1.0, 0.0);
          std::uint64_t cell = 0;
          for (std::size_t axis = 0; axis < 3; ++axis)
            cell = cell * 1024 + static_cast<std::uint64_t>(place[axis] * w.box[axis] / 2 * std::ldexp(1.0, level));
          cells.insert(cell);
        }
        const double expected = model::occupied_cell_spheres(w, level);
        CHECK(std::abs(static_cast<double>(cells.size()) - expected) <= 5 * std::sqrt(expected));
        CHECK(std::abs(static_cast<double>(cells.size()) - expected) <= 0.02 * expected);
      }
  }

  // The standard deviation of the number of occupied cells is less than √cells; up to five deviations are allowed.
  TEST_CASE("occupied cells are as counted on random samples") {
    constexpr int samples = 20'000;
    for (const int level : {2, 4, 5, 6}) {
      std::set<std::uint64_t> cells;
      const double along = std::ldexp(1.0, level);
      for (std::uint64_t i = 0; i < samples; ++i) {
        const auto u = sim::uniform4(17, sim::Stream::tests, i);
        std::uint64_t cell = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) cell = cell * 1024 + static_cast<std::uint64_t>(u[axis] * along);
        cells.insert(cell);
      }
      const double expected = model::occupied_cell_spheres(samples, level);
      CHECK(std::abs(static_cast<double>(cells.size()) - expected) <= 5 * std::sqrt(expected));
      CHECK(std::abs(static_cast<double>(cells.size()) - expected) <= 0.02 * expected);
    }
  }

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
  TEST_CASE("levels and samples out of range are refused by name") {
    CHECK_THROWS_WITH_AS((void)model::occupied_cell_spheres(10, -1), doctest::Contains("level"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::occupied_cell_spheres(0.5, 1), doctest::Contains("samples"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::cell_sphere_counts(workload, {17}), doctest::Contains("depth"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::occupied_cell_spheres(workload, 301), doctest::Contains("level"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::rays_in_cell_sphere(workload, -1), doctest::Contains("level"),
                         std::invalid_argument);
    CHECK_THROWS_AS((void)model::occupied_cell_spheres(Workload{}, 1), std::invalid_argument);
    CHECK_THROWS_AS((void)model::cell_sphere_radius(Workload{}, 1), std::invalid_argument);
  }

  TEST_CASE("parameters and workloads out of range are refused by name") {
    CHECK_THROWS_WITH_AS((void)model::sphere_tree_levels(in_volume, {1, 8}), Contains("fan-out"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::sphere_tree_counts(in_volume, {8, 0}), Contains("leaf"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::sphere_tree_counts(Workload{}, {8, 8}), Contains("rays"), std::invalid_argument);
  }
}
