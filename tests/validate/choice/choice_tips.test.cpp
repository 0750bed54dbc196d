#include "detp/validate/choice/tips.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <stop_token>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

/// Samples on the faces of a cube and lines, piloted as if there were `rays` rays. Costs are those of one thread.
struct Tipping {
  explicit Tipping(double count, double radius = 0.02)
      : rays(count),
        discs(sim::uniform_discs(sim::Body::cube_faces, 2, 2000, radius, 3)),
        lines(sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, 500)),
        problem(sim::make_problem(lines, discs)),
        workload(cube_workload(count, 2000, radius, 2, 2)) {}

  [[nodiscard]] Question question(double number) const {
    return {.problem = &problem, .rays = lines, .ray_count = number, .workload = workload};
  }
  [[nodiscard]] Choice pilot() const { return pilot_of(rays); }
  [[nodiscard]] Choice pilot_of(double number) const { return choose(question(number), built_in_unit_costs()); }
  [[nodiscard]] Tips tips() const { return tips_of(pilot(), question(rays), built_in_unit_costs()); }

  double rays;
  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> lines;
  sim::Problem problem;
  Workload workload;
};

const Tip* find(const Tips& tips, TipInput input, TipKind kind, bool up) {
  const auto found = std::find_if(tips.tips.begin(), tips.tips.end(), [&](const Tip& tip) {
    return tip.input == input && tip.kind == kind && (tip.ratio > 1) == up;
  });
  return found == tips.tips.end() ? nullptr : &*found;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a pilot with the number of rays of a tip chooses what the tip says; with 5 % more it does not") {
    double first = 0;  // number of rays from which the box tree is chosen
    for (double rays = 4; first == 0; rays *= 2)
      if (Tipping(1).pilot_of(rays).best().candidate.technique == Technique::box_tree) first = rays;
    const Tipping example(2 * first);
    REQUIRE(example.pilot().best().candidate.technique == Technique::box_tree);
    const Tips tips = example.tips();
    const Tip* const tip = find(tips, TipInput::rays, TipKind::technique, false);
    REQUIRE(tip != nullptr);
    CHECK(tip->candidate.technique == Technique::brute_force);
    const auto technique_with = [&](double rays) { return example.pilot_of(rays).best().candidate.technique; };
    CHECK(technique_with(std::floor(0.95 * tip->at)) == Technique::brute_force);
    CHECK(technique_with(std::ceil(1.05 * tip->at) + 1) == Technique::box_tree);
  }

  TEST_CASE("without a pilot, more rays than those of a tip need one") {
    const Tipping example(1);
    const Choice pilot = example.pilot();
    REQUIRE(pilot.discs == nullptr);
    const Tips tips = example.tips();
    for (const Tip& tip : tips.tips) CHECK(tip.kind != TipKind::technique);  // nobody knows the time of a box tree
    double most = 1;
    while (Tipping(2 * most).pilot().discs == nullptr) most *= 2;
    const Tips near = Tipping(most).tips();
    const Tip* const tip = find(near, TipInput::rays, TipKind::not_ruled_out, true);
    REQUIRE(tip != nullptr);
    CHECK(tip->ratio <= 2.1);
  }

  TEST_CASE("the ranking at the inputs of a tip has the tip's technique first, and a little before it has not") {
    const Workload workload = cube_workload(300, 2000, 0.02, 2);
    const CostTable costs = built_in_unit_costs();
    const auto first = [&](double rays, double radius) {
      return model::rank(cube_workload(rays, 2000, radius, 2), costs).front().candidate;
    };
    const Question question{.workload = workload};
    const Tips tips = tips_of(choose(question, costs), question, costs);
    const Tip* const tip = find(tips, TipInput::rays, TipKind::technique, false);
    REQUIRE(tip != nullptr);
    CHECK(first(tip->at, 0.02) == tip->candidate);
    CHECK(first(std::ceil(1.05 * tip->at) + 1, 0.02).technique == first(300, 0.02).technique);
    CHECK(tips.range(TipInput::disc_radius).most == doctest::Approx(16 * 0.02));
  }

  TEST_CASE("disabled techniques are no tips") {
    const Workload workload = cube_workload(300, 2000, 0.02, 2);
    const CostTable costs = built_in_unit_costs();
    const Question question{.workload = workload, .disabled = {Technique::brute_force}};
    for (const Tip& tip : tips_of(choose(question, costs), question, costs).tips)
      CHECK(tip.candidate.technique != Technique::brute_force);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("tips change nothing in the pilot's choice, and its index can be built afterwards") {
    const Tipping example(20'000);
    const auto before = example.pilot();
    auto after = example.pilot();
    static_cast<void>(tips_of(after, example.question(20'000), built_in_unit_costs()));
    REQUIRE(before.candidates.size() == after.candidates.size());
    for (std::size_t i = 0; i < before.candidates.size(); ++i)
      CHECK(before.candidates[i].counts == after.candidates[i].counts);
    const auto index = build_choice(after, example.problem, {});
    CHECK(sim::run(example.problem, *index).total_hits ==
          sim::run(example.problem, {Technique::brute_force, BruteForceParameters{}}).total_hits);
  }
}

TEST_SUITE("degenerate input") {
  TEST_CASE("discs larger than the scene, one ray, and a stop request") {
    for (const double radius : {1e-9, 5.0, 1e6})
      for (const double rays : {1.0, 1e18}) {
        CAPTURE(radius);
        CAPTURE(rays);
        const Workload workload = cube_workload(rays, 1000, radius, 2);
        const CostTable costs = built_in_unit_costs();
        const Question question{.workload = workload};
        for (const Tip& tip : tips_of(choose(question, costs), question, costs).tips) {
          CHECK(tip.at > 0);
          CHECK(std::isfinite(tip.at));
        }
      }
    std::stop_source source;
    source.request_stop();
    const Workload workload = cube_workload(300, 2000, 0.02, 2);
    Choice grid;
    grid.candidates = {{.candidate = default_candidate(Technique::grid)}};
    const Question question{.workload = workload, .stop = source.get_token()};
    const Tips tips = tips_of(grid, question, built_in_unit_costs());
    CHECK(tips.stopped());
    CHECK(tips.tips.empty());
  }
}
