#include <algorithm>
#include <cstdio>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;

/// Returns 0 if the new technique is known by its name, finds the hits of brute force and is ranked.
int main() {
  const auto discs = sim::uniform_discs(sim::Body::cube, 2, 500, 0.05, 1);
  const auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 3000);
  const sim::Problem problem = sim::make_problem({rays}, discs);
  Candidate toy = default_candidate(technique_named("each-pair").value());
  set_parameter(toy, "step", std::int64_t{3});
  const sim::Outcome found = sim::run(problem, toy);
  const sim::Outcome expected = sim::run(problem, default_candidate(Technique::brute_force));
  const Workload workload = cube_workload(3000, 500, 0.05, 2);
  const auto ranking = model::rank(workload, CostTable{});
  const bool ranked =
      std::ranges::any_of(ranking, [&](const Prediction& one) { return one.candidate.technique == toy.technique; });
  std::printf("%s: hits %llu, expected %llu, %s\n", title(toy).c_str(),
              static_cast<unsigned long long>(found.counts.hits), static_cast<unsigned long long>(expected.counts.hits),
              ranked ? "ranked" : "not ranked");
  return ranked && found.counts.hits > 0 && found.counts.hits == expected.counts.hits &&
                 found.counts.disc_tests == 500 * 3000
             ? 0
             : 1;
}
