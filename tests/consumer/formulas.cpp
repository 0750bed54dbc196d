// Only the formulas: predicts which technique is fastest, without a scene.
#include <cstdio>
#include <detp/model/rank/choose.hpp>

int main() {
  const detp::Workload workload = detp::cube_workload(1e5, 1e5, 0.01, 2);
  const auto ranking = detp::model::rank(workload, detp::UnitCosts{});
  std::printf("%s: %.3g tests\n", detp::describe(ranking.front().candidate).c_str(), ranking.front().time.total());
  return ranking.size() > 3 ? 0 : 1;
}
