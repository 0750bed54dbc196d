// An external program: uses the installed package, chooses the best technique, and runs it.
#include <cstdio>
#include <detp/detp.hpp>

int main() {
  using namespace detp;
  const auto discs = sim::uniform_discs(sim::Body::cube, 2, 2000, 0.05, 1);
  const auto rays = sim::LineField(sim::enclosing_sphere(discs), 2).lines(0, 2000);
  const sim::Problem problem = sim::make_problem(rays, discs);
  const auto ranking = model::rank(validate::measure(problem), validate::built_in_unit_costs());
  const sim::Outcome outcome = sim::run(problem, ranking.front().candidate);
  const sim::Outcome expected = sim::run(problem, {Technique::brute_force, BruteForceParameters{}});
  std::printf("%s: %llu hits\n", describe(ranking.front().candidate).c_str(),
              static_cast<unsigned long long>(outcome.total_hits));
  return outcome.total_hits == expected.total_hits && outcome.total_hits > 0 ? 0 : 1;
}
