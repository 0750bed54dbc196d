#include "detp/model/vocabulary/valid.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <type_traits>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/disc_index/index_cells.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/best_published_ratio.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"

namespace {

int workload_checks = 0;
int candidate_checks = 0;
int cost_checks = 0;

}  // namespace

// The linker redirects each call of detp::check to the function with __wrap_ before its symbol. __real_ before the
// symbol calls the original function (tests/CMakeLists.txt).
extern "C" {
void __real__ZN4detp5checkERKNS_8WorkloadE(const detp::Workload& workload);
void __real__ZN4detp5checkERKNS_9CandidateE(const detp::Candidate& candidate);
void __real__ZN4detp5checkERKNS_9UnitCostsE(const detp::UnitCosts& costs);

void __wrap__ZN4detp5checkERKNS_8WorkloadE(const detp::Workload& workload) {
  ++workload_checks;
  __real__ZN4detp5checkERKNS_8WorkloadE(workload);
}

void __wrap__ZN4detp5checkERKNS_9CandidateE(const detp::Candidate& candidate) {
  ++candidate_checks;
  __real__ZN4detp5checkERKNS_9CandidateE(candidate);
}

void __wrap__ZN4detp5checkERKNS_9UnitCostsE(const detp::UnitCosts& costs) {
  ++cost_checks;
  __real__ZN4detp5checkERKNS_9UnitCostsE(costs);
}
}

namespace {

using namespace detp;
using namespace detp::model;

const Workload plain = cube_workload(1e6, 1e5, 0.01, 2);

template <class Call>
void count(const Call& call) {
  workload_checks = candidate_checks = cost_checks = 0;
  (void)call();
}

struct Even {
  int half = 1;
  int twice = 2;
};

void check(const Even& even) {
  if (2 * even.half != even.twice) throw std::invalid_argument("not even");
}

int value_of(Valid<Even>& even) { return even.twice; }

TEST_SUITE("valid") {
  TEST_CASE("a plain value, or its members, become a valid one where their check passes, and throw where it does not") {
    CHECK(value_of(Even{3, 6}) == 6);
    CHECK(value_of({3, 6}) == 6);
    CHECK(value_of({}) == 2);
    CHECK_THROWS_AS(value_of(Even{3, 7}), std::invalid_argument);
    CHECK_THROWS_AS(value_of({3, 7}), std::invalid_argument);
  }

  TEST_CASE("a valid value cannot be changed") {
    static_assert(!std::is_assignable_v<Valid<Even>&, Even>);
    static_assert(!std::is_assignable_v<decltype((std::declval<Valid<Even>&>().twice)), int>);
  }

  TEST_CASE("rank checks the workload and each technique's costs once") {
    count([] { return rank(plain, {}); });
    CHECK(workload_checks == 1);
    CHECK(cost_checks == static_cast<int>(all_techniques.size()));
    Workload bad = plain;
    bad.samples = -1;
    count([&] {
      CHECK_THROWS_AS((void)rank(bad, {}), std::invalid_argument);
      return 0;
    });
    CHECK(workload_checks == 1);
  }

  TEST_CASE("predict checks the workload and the candidate once each") {
    for (const Technique technique : all_techniques) {
      if (!has_closed_form(technique)) continue;
      for (const Engine engine : {Engine::plain, Engine::simd}) {
        CAPTURE(name(technique));
        count([&] { return predict(plain, default_candidate(technique), engine); });
        CHECK(workload_checks == 1);
        CHECK(candidate_checks == 1);
      }
    }
  }

  TEST_CASE("a formula checks a plain workload once, and a valid one never") {
    const auto each = [](const auto& workload) {
      const UnitCosts costs;
      int formulas = 0;
      const auto run_formula = [&](const auto& formula) {
        count([&] { return formula(workload); });
        CAPTURE(formulas);
        CHECK(workload_checks == (std::is_same_v<decltype(workload), const Workload&> ? 1 : 0));
        ++formulas;
      };
      run_formula([](const auto& w) { return crossing_probability(w, 0.01, 0.3); });
      run_formula([](const auto& w) { return expected_hits(w); });
      run_formula([](const auto& w) { return octree_bytes(w, {5}); });
      run_formula([](const auto& w) { return grid_bytes(w, {20}); });
      run_formula([](const auto& w) { return cell_sphere_radius(w, 3); });
      run_formula([](const auto& w) { return rays_in_cell_sphere(w, 3); });
      run_formula([&](const auto& w) { return published::best_ratio(w, costs).time; });
      run_formula([&](const auto& w) { return published::best_stop(w, costs, {0.6}); });
      run_formula([](const auto& w) { return published::counts(w, {0.6}, 4).culls; });
      run_formula([&](const auto& w) { return best_ratio_and_stop(w, costs).time; });
      run_formula([&](const auto& w) { return good_ratio_below(w, costs, 1e300).time; });
      run_formula([&](const auto& w) { return best_stop(w, costs, {0.6}).time; });
      run_formula([&](const auto& w) { return best_ratio_for(w, costs, 4).time; });
      run_formula([&](const auto& w) { return complete(Technique::octree, {}, w, costs); });
      run_formula([&](const auto& w) { return assess(w, default_candidate(Technique::sphere_tree), costs); });
      run_formula([](const auto& w) { return paper_rule(w); });
    };
    each(plain);
    each(Valid<Workload>(plain));
  }
}

}  // namespace
