#include "detp/validate/calibration/calibration_file.hpp"

#include <doctest/doctest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "support/sanitized.hpp"
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
