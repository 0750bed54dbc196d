#include "detp/validate/choice/plan_memory.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/open/uniform_discs.hpp"
#include "detp/validate/choice/plan.hpp"

using namespace detp;
using validate::PlanMemory;
using validate::RememberedChoice;
using validate::WorkloadClass;

namespace {

constexpr WorkloadClass some_class{.rays = 10, .discs = 12, .spacing = 1, .dimension = 8, .path_length = -2};

RememberedChoice choice_by(Rigor rigor, bool cut_off = false) {
  return {.candidate = {Technique::box_tree, BoxTreeParameters{8, 32}},
          .threads = 1,
          .predicted_seconds = 0.5,
          .predicted_error = 0.01,
          .rigor = rigor,
          .cut_off = cut_off};
}

std::vector<sim::Disc> remembered_discs(double radius = 0.03) {
  return sim::uniform_discs(sim::Body::cube_faces, 2, 3000, radius, 3);
}

std::vector<sim::Ray> remembered_rays(std::size_t count) { return sim::LineField({{0, 0, 0}, 2}, 1).lines(0, count); }

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a choice is found again at its rigor and below, and only for its class") {
    PlanMemory memory;
    CHECK_FALSE(memory.find(some_class, Rigor::estimate));
    memory.remember(some_class, choice_by(Rigor::structural));
    CHECK(memory.size() == 1);
    CHECK(memory.find(some_class, Rigor::estimate) == choice_by(Rigor::structural));
    CHECK(memory.find(some_class, Rigor::structural) == choice_by(Rigor::structural));
    CHECK_FALSE(memory.find(some_class, Rigor::pilot));
    WorkloadClass other = some_class;
    other.front_facing = true;
    CHECK_FALSE(memory.find(other, Rigor::estimate));
  }

  TEST_CASE("a choice is replaced by one of at least its rigor, and that was not cut off if it was not") {
    PlanMemory memory;
    for (const auto& [next, kept] : {std::pair{choice_by(Rigor::structural, true), choice_by(Rigor::structural, true)},
                                     std::pair{choice_by(Rigor::structural), choice_by(Rigor::structural)},
                                     std::pair{choice_by(Rigor::structural, true), choice_by(Rigor::structural)},
                                     std::pair{choice_by(Rigor::estimate), choice_by(Rigor::structural)},
                                     std::pair{choice_by(Rigor::pilot, true), choice_by(Rigor::pilot, true)}}) {
      memory.remember(some_class, next);
      CHECK(memory.find(some_class, Rigor::estimate) == kept);
    }
  }

  TEST_CASE("many threads may use one memory") {
    PlanMemory memory;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&memory, i] {
        for (int rays = 0; rays < 100; ++rays) {
          memory.remember({.rays = rays, .discs = i % 2}, choice_by(Rigor::pilot));
          static_cast<void>(memory.find({.rays = rays}, Rigor::estimate));
          static_cast<void>(memory.entries());
        }
      });
    for (std::thread& thread : threads) thread.join();
    CHECK(memory.size() == 200);
  }

  TEST_CASE("a plan is remembered, and used for the next plan of the same class with the same hits") {
    const auto discs = remembered_discs();
    const auto rays = remembered_rays(2000);
    PlanMemory memory;
    const auto first = validate::plan(discs, rays, {.memory = &memory});
    CHECK_FALSE(first.remembered());
    REQUIRE(memory.size() == 1);
    const auto again = validate::plan(discs, rays, {.memory = &memory, .remembered_only = true});
    CHECK(again.remembered());
    CHECK(again.rigor() == Rigor::pilot);
    CHECK(again.candidate() == first.candidate());
    CHECK(again.predicted_seconds() == first.predicted_seconds());
    sim::SearchScratch one;
    sim::SearchScratch other;
    CHECK(validate::execute(first, rays, one).irradiance == validate::execute(again, rays, other).irradiance);
  }

  TEST_CASE("a remembered choice of less rigor is not used, and is replaced") {
    const auto discs = remembered_discs();
    const auto rays = remembered_rays(2000);
    PlanMemory memory;
    static_cast<void>(validate::plan(discs, rays, {.memory = &memory}));
    const WorkloadClass found = memory.entries().front().workload;
    PlanMemory weaker;
    RememberedChoice guess = choice_by(Rigor::estimate);
    guess.candidate = {Technique::grid, GridParameters{7}};
    weaker.remember(found, guess);
    CHECK_FALSE(validate::plan(discs, rays, {.memory = &weaker}).remembered());
    CHECK(weaker.find(found, Rigor::pilot));
    guess.rigor = Rigor::pilot;
    PlanMemory wrong;
    wrong.remember(found, guess);
    CHECK(validate::plan(discs, rays, {.memory = &wrong}).candidate() == guess.candidate);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("if only remembered choices may be used, a miss says what was wanted and what there is") {
    const auto discs = remembered_discs();
    const auto rays = remembered_rays(2000);
    PlanMemory memory;
    const auto planned = [&](const std::vector<sim::Disc>& these) {
      return validate::plan(these, rays, {.memory = &memory, .remembered_only = true});
    };
    CHECK_THROWS_WITH_AS(static_cast<void>(planned(discs)), doctest::Contains("nothing is remembered"),
                         validate::NotRemembered);
    static_cast<void>(validate::plan(discs, rays, {.memory = &memory}));
    CHECK_THROWS_WITH_AS(static_cast<void>(planned(remembered_discs(0.3))),
                         doctest::Contains("the nearest is for about"), validate::NotRemembered);
    const PlanMemory::Entry made = memory.entries().front();
    PlanMemory weaker;
    weaker.remember(made.workload, choice_by(Rigor::estimate));
    CHECK_THROWS_WITH_AS(static_cast<void>(weaker.require(made.workload, Rigor::pilot)),
                         doctest::Contains("wanted rigor pilot for about 2.05e+03 rays, 4.1e+03 discs"),
                         validate::NotRemembered);
    CHECK_THROWS_WITH_AS(static_cast<void>(weaker.require(made.workload, Rigor::pilot)),
                         doctest::Contains("box-tree, fan-out 8, leaf 32 by rigor estimate"), validate::NotRemembered);
    CHECK_THROWS_AS(static_cast<void>(validate::plan(discs, rays, {.remembered_only = true})), std::invalid_argument);
  }

  TEST_CASE("a malformed ray is named by its number, with a memory too") {
    const auto discs = remembered_discs();
    std::vector<sim::Ray> rays = remembered_rays(5000);
    for (std::size_t i = 3000; i < rays.size(); ++i) rays[i].direction = {0, 0, 0};
    PlanMemory memory;
    CHECK_THROWS_WITH_AS(static_cast<void>(validate::plan(discs, rays, {.memory = &memory})),
                         doctest::Contains("ray 3000:"), std::invalid_argument);
    CHECK(memory.size() == 0);
  }

  TEST_CASE("choices with impossible values are refused") {
    PlanMemory memory;
    const auto refused = [&](auto&& change) {
      RememberedChoice bad = choice_by(Rigor::pilot);
      change(bad);
      CHECK_THROWS_AS(memory.remember(some_class, bad), std::invalid_argument);
    };
    refused([](RememberedChoice& one) { one.candidate.parameters = BoxTreeParameters{1, 1}; });
    refused([](RememberedChoice& one) { one.candidate = default_candidate(Technique::photon_map); });
    refused([](RememberedChoice& one) { one.threads = -1; });
    refused([](RememberedChoice& one) { one.predicted_seconds = std::nan(""); });
    refused([](RememberedChoice& one) { one.predicted_error = -1; });
    CHECK(memory.size() == 0);
  }
}
