#include "detp/validate/calibration/calibration.hpp"

#include <doctest/doctest.h>
#include <stdlib.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tuple>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/calibration/timed_workloads.hpp"
#include "support/machine.hpp"
#include "support/scratch_file.hpp"

using namespace detp;

namespace {

/// $XDG_CACHE_HOME is this folder, and then none again.
struct CacheFolder {
  support::ScratchFolder folder;
  CacheFolder() { ::setenv("XDG_CACHE_HOME", folder.path("cache").c_str(), 1); }
  ~CacheFolder() { ::setenv("XDG_CACHE_HOME", "/dev/null", 1); }
};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a key is read back from JSON as it was written") {
    const validate::CalibrationKey here = validate::this_machine();
    CHECK(validate::key_of(validate::to_json(here)) == here);
  }

  TEST_CASE("equal keys do not differ; each difference is named") {
    const validate::CalibrationKey here = validate::this_machine();
    CHECK(validate::difference(here, here).empty());
    validate::CalibrationKey other = here;
    other.threads += 1;
    CHECK(validate::difference(other, here).find("number of threads") != std::string::npos);
    other = here;
    other.instruction_set = "MMX";
    CHECK(validate::difference(other, here).find("instruction set is MMX, here it is") != std::string::npos);
    other = here;
    other.cost_model += 1;
    CHECK(validate::difference(other, here).find("cost model") != std::string::npos);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a key with a missing value is refused") {
    nlohmann::ordered_json json = validate::to_json(validate::this_machine());
    json.erase("cpu");
    CHECK_THROWS_AS(static_cast<void>(validate::key_of(json)), nlohmann::json::exception);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a calibration is doubtful if its error is large or if other programs took much of the time") {
    CHECK(validate::CalibrationQuality{0.14, 0.95}.doubt().empty());
    CHECK(validate::CalibrationQuality{0.22, 0.95}.doubt() == "its median error is 22 %, more than 15 %");
    CHECK(validate::CalibrationQuality{0.05, 0.6}.doubt() == "other programs took 40 % of the time of its runs");
    CHECK(validate::CalibrationQuality{0.3, 0.6}.doubt().find("; other programs") != std::string::npos);
  }

  TEST_CASE("the relative error is the standard deviation whose median is the median error") {
    // half of a normal distribution is within 0.6745 standard deviations
    CHECK(std::erf(0.6745 / std::sqrt(2.0)) == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(validate::CalibrationQuality{0.06745, 1}.relative_error() == doctest::Approx(0.1));
    CHECK(validate::CalibrationQuality{0.06745, 0.5}.relative_error() == doctest::Approx(0.5));
  }

  TEST_CASE("one without doubt is better than a doubtful one, else the one with the smaller error") {
    CHECK(validate::CalibrationQuality{0.14, 0.95}.is_better_than({0.01, 0.5}));
    CHECK_FALSE(validate::CalibrationQuality{0.01, 0.5}.is_better_than({0.14, 0.95}));
    CHECK(validate::CalibrationQuality{0.04, 1}.is_better_than({0.05, 1}));
    CHECK(validate::CalibrationQuality{0.2, 1}.is_better_than({0.3, 1}));
    CHECK_FALSE(validate::CalibrationQuality{0.2, 1}.is_better_than({0.2, 1}));
  }
}

TEST_SUITE("probe") {
  TEST_CASE("a machine without costs is probed once, and detp calibrate knows better") {
    CHECK_FALSE(validate::stored_calibration());
    validate::probe_once();  // nowhere to keep it: nothing happens
    CHECK_FALSE(validate::stored_calibration());
    CHECK(validate::stored_unit_costs() == validate::built_in_unit_costs(Engine::simd));
    const CacheFolder cache;
    validate::probe_once();
    const auto found = validate::stored_calibration();
    REQUIRE(found);
    CHECK(found->probe);
    CHECK(found->doubt().empty());
    const std::string text = support::content_of(validate::probe_path());
    validate::probe_once();
    CHECK(support::content_of(validate::probe_path()) == text);
    validate::Calibration measured;
    measured.simd = measured.plain = validate::built_in_unit_costs(Engine::simd);
    measured.left_out_median_error = 0.3;
    CHECK(measured.is_better_than(*found));
    CHECK_FALSE(found->is_better_than(measured));
    CHECK(validate::save_calibration(validate::default_calibration_path(), measured).empty());
    CHECK_FALSE(validate::stored_calibration()->probe);
  }

  TEST_CASE("each technique has one factor for sorting and building, and one for all other costs but touching memory") {
    const sim::Stopwatch watch;
    const validate::Calibration found = validate::probe();
    CHECK(watch.seconds() < (support::sanitized ? 60 : 2));
    for (const Engine engine : {Engine::simd, Engine::plain}) {
      const CostTable usual = validate::built_in_unit_costs(engine);
      for (const Technique technique : all_techniques) {
        CAPTURE(name(technique));
        std::array<double, 2> factors{};
        for (const UnitCostTerm& term : unit_cost_terms) {
          if (term.cost == &UnitCosts::touch) continue;  // measured by itself
          const double before = usual[technique].*term.cost;
          const double after = found.of(engine)[technique].*term.cost;
          if (before == 0) CHECK(after == 0);
          if (before == 0) continue;
          double& factor = factors[term.part == &CostBreakdown::order || term.part == &CostBreakdown::build ? 0 : 1];
          if (factor == 0) factor = after / before;
          CHECK(after / before == doctest::Approx(factor));
          CHECK(factor > 0);
        }
      }
    }
  }
}

namespace detp::validate {
namespace {

constexpr TimedWorkload workload{sim::Body::cube, 1000, 200, 0.01};

/// Number of cells of a grid over the discs' box that hold a centre, eight cells a side.
std::size_t filled_cells(const std::vector<sim::Disc>& discs) {
  sim::Box box;
  for (const sim::Disc& disc : discs) box.include(disc.centre);
  std::set<std::tuple<int, int, int>> cells;
  for (const sim::Disc& disc : discs) {
    const glm::dvec3 cell = 7.999 * (disc.centre - box.low) / (box.high - box.low);
    cells.emplace(static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z));
  }
  return cells.size();
}

double distance_to_nearest(const glm::dvec3& point, const std::vector<sim::Disc>& discs) {
  double least = sim::unbounded;
  for (const sim::Disc& disc : discs) least = std::min(least, glm::length(disc.centre - point));
  return least;
}

}  // namespace

TEST_SUITE("timed workloads") {
  TEST_CASE("the samples of every third workload lie in clusters: they fill far fewer cells") {
    for (std::size_t place = 0; place < 12; ++place) {
      CAPTURE(place);
      const std::size_t filled = filled_cells(discs_of(workload, place));
      if (place % 3 == 2)
        CHECK(filled < 250);
      else
        CHECK(filled > 400);
    }
  }

  TEST_CASE("half of the workloads have lines, a quarter pieces of lines, a quarter paths from sample to sample") {
    int lines = 0;
    int paths = 0;
    for (std::size_t place = 0; place < 16; ++place) {
      const auto discs = discs_of(workload, place);
      const auto rays = rays_of(workload, discs, place);
      CHECK(rays.size() == workload.rays);
      if (rays.front().length == sim::unbounded) ++lines;
      bool between = true;
      for (const sim::Ray& ray : rays) {
        CHECK(std::abs(glm::length(ray.direction) - 1) < 1e-12);
        between = between && ray.length < sim::unbounded && distance_to_nearest(ray.origin, discs) < 1e-3 &&
                  distance_to_nearest(ray.origin + ray.length * ray.direction, discs) < 2e-3;
      }
      if (between) ++paths;
    }
    CHECK(lines == 8);
    CHECK(paths == 4);
  }
}

}  // namespace detp::validate
