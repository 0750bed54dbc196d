#include "detp/validate/choice/tips.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
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

constexpr TipInputs present{.disc_radius = 0.5, .rays = 1000, .threads = 4};
constexpr TipSearch search{.factor = 4, .steps = 4, .most_threads = 8};

ChoiceThere grid_on(int threads) {
  return {{.candidate = default_candidate(Technique::grid), .time = {.intersect = 1}, .threads = threads}, 1};
}

/// The same technique for all inputs, on up to 4 threads.
int threads_of(const TipInputs& inputs) { return static_cast<int>(inputs.threads); }

ChoiceThere grid_for(const TipInputs& inputs) { return grid_on(std::min(4, threads_of(inputs))); }

/// The only tip.
Tip only_tip(const ChooseForInputs& choose) {
  const Tips found = find_tips(present, search, choose);
  REQUIRE(found.tips.size() == 1);
  return found.tips.front();
}

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
  TEST_CASE("where another technique is chosen is found to 5 %, on the side of that technique") {
    for (const double limit : {0.13, 0.3, 0.49, 0.51, 1.0, 1.9}) {
      CAPTURE(limit);
      const auto tip = only_tip([&](const TipInputs& inputs) {
        ChoiceThere choice = grid_for(inputs);
        const bool beyond = limit > present.disc_radius ? inputs.disc_radius >= limit : inputs.disc_radius <= limit;
        if (beyond) choice.best.candidate = default_candidate(Technique::octree);
        return choice;
      });
      CHECK(tip.input == TipInput::disc_radius);
      CHECK(tip.kind == TipKind::technique);
      CHECK(tip.candidate.technique == Technique::octree);
      CHECK(tip.ratio == doctest::Approx(tip.at / 0.5));
      const double behind = limit > present.disc_radius ? tip.at / limit : limit / tip.at;
      CHECK(behind >= 1);
      CHECK(behind <= 1.05);
    }
  }

  TEST_CASE("numbers of rays are whole numbers, at least 1") {
    const TipInputs few{.disc_radius = 0.5, .rays = 3, .threads = 1};
    const auto choose = [](const TipInputs& inputs) {
      CHECK(inputs.rays == std::round(inputs.rays));
      CHECK(inputs.rays >= 1);
      ChoiceThere choice = grid_on(1);
      if (inputs.rays < 2.5 || inputs.rays > 6.5) choice.best.candidate = default_candidate(Technique::octree);
      return choice;
    };
    const Tips found = find_tips(few, {}, choose);
    REQUIRE(found.tips.size() == 2);
    CHECK(found.tips[0].at == 2);
    CHECK(found.tips[1].at == 7);
    CHECK(found.range(TipInput::rays).least == 2);  // nothing is examined behind another technique
  }

  TEST_CASE("other parameters are a tip if they are 15 % faster") {
    const double slope = 0.4;
    const auto tip = only_tip([&](const TipInputs& inputs) {
      ChoiceThere choice = grid_for(inputs);
      choice.best.candidate.parameters = GridParameters{inputs.rays > 1000 ? 9 : 8};
      choice.unchanged_seconds = 1 + slope * std::max(0.0, std::log2(inputs.rays / 1000));
      return choice;
    });
    CHECK(tip.input == TipInput::rays);
    CHECK(tip.kind == TipKind::parameters);
    CHECK(std::get<GridParameters>(tip.candidate.parameters).cells == 9);
    CHECK(tip.ratio == doctest::Approx(std::exp2(0.15 / slope)).epsilon(0.05));
  }

  TEST_CASE("other numbers of threads are a tip, unless only the cap is lower") {
    CHECK(find_tips(present, search, [](const TipInputs& inputs) { return grid_for(inputs); }).tips.empty());
    const auto more = only_tip([](const TipInputs& inputs) { return grid_on(threads_of(inputs)); });
    CHECK(more.input == TipInput::threads);
    CHECK(more.kind == TipKind::threads);
    CHECK(more.at == 8);
    CHECK(more.threads == 8);
    const auto fewer = only_tip(
        [](const TipInputs& inputs) { return grid_on(inputs.rays < 300 ? 1 : std::min(4, threads_of(inputs))); });
    CHECK(fewer.input == TipInput::rays);
    CHECK(fewer.threads == 1);
    CHECK(fewer.at < 300);
    CHECK(fewer.at > 285);
  }

  TEST_CASE("a technique that is ruled out now, but not there, is a tip; one that is never ruled out is none") {
    const auto tip = only_tip([](const TipInputs& inputs) {
      ChoiceThere choice = grid_for(inputs);
      choice.not_ruled_out = {Technique::bsp};
      if (inputs.disc_radius > 0.8) choice.not_ruled_out.push_back(Technique::ray_map);
      return choice;
    });
    CHECK(tip.kind == TipKind::not_ruled_out);
    CHECK(tip.candidate.technique == Technique::ray_map);
    CHECK(tip.at == doctest::Approx(0.81).epsilon(0.05));
  }

  TEST_CASE("behind another technique, other changes are no tips") {
    const Tips found = find_tips(present, search, [](const TipInputs& inputs) {
      ChoiceThere choice = grid_for(inputs);
      if (inputs.disc_radius > 0.6) choice.best.candidate = default_candidate(Technique::octree);
      if (inputs.disc_radius > 0.65) choice.not_ruled_out = {Technique::ray_map};
      return choice;
    });
    REQUIRE(found.tips.size() == 1);
    CHECK(found.tips.front().kind == TipKind::technique);
  }

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

TEST_SUITE("degenerate input") {
  TEST_CASE("if nothing changes there is no tip, and the whole range was examined with few choices") {
    const Tips found = find_tips(present, search, [](const TipInputs& inputs) { return grid_for(inputs); });
    CHECK(found.tips.empty());
    CHECK_FALSE(found.stopped());
    CHECK(found.range(TipInput::disc_radius).least == doctest::Approx(0.125));
    CHECK(found.range(TipInput::disc_radius).most == doctest::Approx(2));
    CHECK(found.range(TipInput::rays).least == 250);
    CHECK(found.range(TipInput::rays).most == 4000);
    CHECK(found.range(TipInput::threads).least == 1);
    CHECK(found.range(TipInput::threads).most == 8);
    CHECK(found.choices == 1 + 4 * 4 + 3);
  }

  TEST_CASE("inputs without a choice end the range") {
    const Tips found = find_tips(present, search, [](const TipInputs& inputs) -> std::optional<ChoiceThere> {
      if (inputs.disc_radius < 0.3) return std::nullopt;
      return grid_for(inputs);
    });
    CHECK(found.tips.empty());
    CHECK(found.range(TipInput::disc_radius).least > 0.3);
    CHECK(found.range(TipInput::disc_radius).most == doctest::Approx(2));
  }

  TEST_CASE("a stop request ends the search, with the tips so far") {
    std::stop_source source;
    const Tips found = find_tips(
        present, search,
        [&](const TipInputs& inputs) {
          if (inputs.rays != 1000) source.request_stop();
          ChoiceThere choice = grid_for(inputs);
          if (inputs.disc_radius < 0.4) choice.best.candidate = default_candidate(Technique::octree);
          return choice;
        },
        source.get_token());
    CHECK(found.stopped());
    CHECK(found.inputs == 1);
    CHECK(found.tips.size() == 1);
    CHECK(found.range(TipInput::rays).least == 1000);
  }

  TEST_CASE("discs larger than the scene, one ray, and a stop request") {
    for (const double radius : {1e-9, 5.0, 1e6})
      for (const double rays : {1.0, 1e18}) {
        INFO("radius ", radius, ", rays ", rays);
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
