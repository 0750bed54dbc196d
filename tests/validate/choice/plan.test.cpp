#include "detp/validate/choice/plan.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/choice/candidate_json.hpp"
#include "detp/validate/choice/comparison.hpp"
#include "detp/validate/choice/plan_basis.hpp"

using namespace detp;
using doctest::Approx;
using validate::LateSearcher;
using Json = nlohmann::ordered_json;

namespace {

std::vector<sim::Disc> some_discs() { return sim::uniform_discs(sim::Body::cube_faces, 2, 3000, 0.03, 3); }

std::vector<sim::Ray> some_rays(const std::vector<sim::Disc>& discs, std::uint64_t seed, std::size_t count) {
  return sim::LineField(sim::enclosing_sphere(discs), seed).lines(0, count);
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a plan finds the hits of brute force, for each frame of rays") {
    const auto discs = some_discs();
    const auto made = validate::plan(discs, some_rays(discs, 1, 2000));
    sim::SearchScratch scratch;
    for (std::uint64_t frame = 1; frame <= 3; ++frame) {
      const auto rays = some_rays(discs, frame, 2000);
      const auto all = sim::run(sim::make_problem(rays, discs), {Technique::brute_force, BruteForceParameters{}});
      const sim::Outcome& found = validate::execute(made, rays, scratch);
      CHECK(found.hits == all.hits);
      CHECK(found.irradiance == all.irradiance);
    }
  }

  TEST_CASE("a searcher is built once, when it is needed; after an error the next call tries again") {
    const std::vector<sim::Disc> discs{{.centre = {0, 0, 0}, .normal = {0, 0, 1}, .radius = 1}};
    int calls = 0;
    LateSearcher late([&](const std::stop_token&) {
      if (++calls == 1) throw std::length_error("no memory");
      return sim::Searcher(discs, default_candidate(Technique::brute_force));
    });
    CHECK_FALSE(late.is_built());
    CHECK_THROWS_AS(static_cast<void>(late.get()), std::length_error);
    CHECK_FALSE(late.is_built());
    const sim::Searcher& first = late.get();
    CHECK(late.is_built());
    CHECK(&late.get() == &first);
    CHECK(calls == 2);
    CHECK(LateSearcher(sim::Searcher(discs, default_candidate(Technique::brute_force))).is_built());
  }

  TEST_CASE("every candidate is read back as it was written") {
    for (const Technique technique : all_techniques)
      for (const Candidate& candidate : small_variants(technique))
        CHECK(candidate_of(technique, Json::parse(to_json(candidate).dump())) == candidate);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("with costs of the plain engine, that engine is planned and finds the same hits") {
    const auto discs = some_discs();
    const auto rays = some_rays(discs, 1, 2000);
    const auto made = validate::plan(discs, rays, {.costs = validate::built_in_unit_costs(Engine::plain)});
    sim::SearchScratch scratch;
    const sim::Outcome found = validate::execute(made, rays, scratch);
    CHECK(found.hits == validate::execute(validate::plan(discs, rays), rays, scratch).hits);
    CHECK(found.vectors.cull + found.vectors.test == 0);
  }

  TEST_CASE("the number of threads is planned, up to the cap") {
    const auto discs = some_discs();
    const auto rays = some_rays(discs, 1, 300);
    CostTable costs = validate::built_in_unit_costs();
    costs.threads.fill({.serial_preparing = 0.5, .serial_search = 0.1, .start = 1e-3});
    const int cores = sim::useful_threads(0);
    CHECK(validate::plan(discs, rays, {.costs = costs, .rays = 10, .threads = 0}).threads() == 1);
    CHECK(validate::plan(discs, rays, {.costs = costs, .rays = 1e8, .threads = 0}).threads() == cores);
    CHECK(validate::plan(discs, rays, {.costs = costs, .rays = 1e8}).threads() == 1);
  }

  TEST_CASE("the plan depends on the number of rays that is announced") {
    const auto discs = some_discs();
    const auto rays = some_rays(discs, 1, 300);
    const auto few = validate::plan(discs, rays, {.rays = 2});
    const auto many = validate::plan(discs, rays, {.rays = 1e8});
    CHECK(few.candidate().technique == Technique::brute_force);
    CHECK(many.candidate().technique == Technique::box_tree);
    CHECK(many.predicted_seconds() > 1000 * few.predicted_seconds());
    CHECK(many.predicted_error() > 0);
    CHECK(many.planning_seconds() > 0);
  }

  TEST_CASE("rays from too far away for floats are planned by closed forms") {
    const auto discs = some_discs();
    std::vector<sim::Ray> rays = some_rays(discs, 1, 50);
    for (sim::Ray& ray : rays) ray.origin -= 1e12 * ray.direction;
    const auto made = validate::plan(discs, rays, {.farthest = 2e12});
    sim::SearchScratch scratch;
    const auto all = sim::run(sim::make_problem(rays, discs), {Technique::brute_force, BruteForceParameters{}});
    CHECK(validate::execute(made, rays, scratch).hits == all.hits);
  }

  TEST_CASE("plans by closed forms, and their replans, have the selected effects") {
    const auto discs = some_discs();  // on surfaces
    const auto rays = some_rays(discs, 1, 2000);
    std::vector<double> seconds;
    for (const char* effects : {"auto", "none"}) {
      const validate::PlanOptions options{.farthest = 2e12, .effects = sim::EffectSelection(effects)};
      const auto effort =
          sim::EvidenceEffort::for_search(static_cast<double>(rays.size()), static_cast<double>(discs.size()));
      Workload workload = sim::observe(sim::make_problem(rays, discs), {}, options.effects, {}, effort).workload;
      const auto made = validate::plan(discs, rays, options);
      CHECK(made.predicted_seconds() == validate::allowed_ranking(workload, options.costs, {}).front().time.total());
      const auto again = replan(made, 0.06);
      workload = with_disc_radius(workload, 0.06);
      CHECK(again.predicted_seconds() ==
            Approx(model::assess(workload, again.candidate(), options.costs).time.total()));
      seconds.push_back(made.predicted_seconds());
    }
    CHECK(seconds[0] != seconds[1]);
  }

  TEST_CASE("names have underscores; parameters that are missing have their defaults") {
    const Candidate tree{Technique::box_tree, BoxTreeParameters{16, 64}};
    CHECK(to_json(tree) == Json{{"fan_out", 16}, {"leaf", 64}});
    CHECK(candidate_of(Technique::grid, Json::object()) == default_candidate(Technique::grid));
  }
}

TEST_SUITE("progress") {
  TEST_CASE("a plan reports its phases in order, and a callback can cancel it in each") {
    const auto discs = some_discs();
    const auto rays = some_rays(discs, 1, 300);
    for (const double farthest : {10.0, 2e12}) {  // by a pilot and by closed forms
      std::vector<sim::Phase> phases;
      static_cast<void>(validate::plan(
          discs, rays, {.farthest = farthest, .progress = [&](const sim::Phase& one) { phases.push_back(one); }}));
      REQUIRE(phases.size() == 3);
      CHECK(phases.front().from == 0);
      CHECK(phases.back().to == 1);
      for (std::size_t i = 1; i < phases.size(); ++i) CHECK(phases[i].from == phases[i - 1].to);
      for (const sim::Phase& last : phases) {
        CAPTURE(last.what);
        std::stop_source source;
        const auto cancel = [&](const sim::Phase& one) {
          CHECK(one.from <= last.from);
          if (one.what == last.what) source.request_stop();
        };
        CHECK_THROWS_AS(static_cast<void>(validate::plan(
                            discs, rays, {.farthest = farthest, .stop = source.get_token(), .progress = cancel})),
                        sim::Stopped);
      }
    }
  }

  TEST_CASE("an execution reports its share, and a callback can stop it after a block of rays") {
    const auto discs = some_discs();
    const auto rays = some_rays(discs, 1, 300'000);  // more than a block
    const auto made = validate::plan(discs, rays);
    REQUIRE(made.candidate().technique == Technique::box_tree);
    sim::SearchScratch scratch;
    std::vector<double> shares;
    std::stop_source source;
    const sim::Outcome& found =
        validate::execute(made, rays, scratch, {.stop = source.get_token(), .progress = [&](double share) {
                                                  shares.push_back(share);
                                                  if (share > 0) source.request_stop();
                                                }});
    REQUIRE(shares.size() == 2);
    CHECK(shares[0] == 0);
    CHECK(found.stopped);
    CHECK(static_cast<double>(found.progress.done) == Approx(300'000 * shares[1]));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("no rays, no discs, a ray too far away, a stop request") {
    const auto discs = some_discs();
    const auto rays = some_rays(discs, 1, 50);
    CHECK_THROWS_AS(static_cast<void>(validate::plan(discs, {})), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(validate::plan({}, rays)), std::invalid_argument);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(static_cast<void>(validate::plan(discs, rays, {.stop = source.get_token()})), sim::Stopped);
    std::vector<sim::Ray> many = some_rays(discs, 1, 5000);
    for (std::size_t i = 3000; i < many.size(); ++i) many[i].direction = {0, 0, 0};
    CHECK_THROWS_WITH_AS(static_cast<void>(validate::plan(discs, many)), doctest::Contains("ray 3000:"),
                         std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(validate::plan(discs, rays, {.rays = 0})), std::invalid_argument);
    for (const int threads : {-1, 1'000'000})
      CHECK_THROWS_WITH_AS(static_cast<void>(validate::plan(discs, rays, {.threads = threads})),
                           doctest::Contains("number of threads"), std::invalid_argument);
    const auto made = validate::plan(discs, rays);
    sim::SearchScratch scratch;
    const std::vector<sim::Ray> far{{.origin = {1e9, 0, 0}, .direction = {1, 0, 0}}};
    CHECK_THROWS_AS(validate::execute(made, far, scratch), std::invalid_argument);
  }

  TEST_CASE("unknown parameters and values of another kind or out of range are refused") {
    for (const Json& bad :
         {Json(), Json::array(), Json{{"fan_in", 2}}, Json{{"fan_out", "two"}}, Json{{"fan_out", 2.5}},
          Json{{"fan_out", nullptr}}, Json{{"fan_out", 1}}, Json{{"leaf", UINT64_MAX}}})
      CHECK_THROWS_AS(static_cast<void>(candidate_of(Technique::box_tree, bad)), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(candidate_of(Technique::sphere_cache, Json{{"order", "random"}})),
                    std::invalid_argument);
  }
}
