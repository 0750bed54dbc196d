#include <fmt/format.h>
#include <cstdlib>
#include <cstdio>
#include "detp/model/rank/choose.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/regret/exhaustive.hpp"
#include "detp/validate/regret/regret_workloads.hpp"
using namespace detp; using namespace detp::validate;
int main(int n, char** a) {
  const auto effort = n > 1 && a[1][0]=='s' ? RegretEffort::small : RegretEffort::thorough;
  const int stride = n > 2 ? atoi(a[2]) : 1; const int from = n>3? atoi(a[3]):0;
  const char* f = getenv("DETP_SCENES");
  const auto all = regret_workloads(effort, f ? f : "");
  fmt::print("w,scene,held,field,rays,discs,radius,D,X,tech,par,abandoned,sel,jud,order,build,search,vcull,vtest");
  for (auto& t : count_terms<double>) fmt::print(",{}", t.name);
  for (auto& t : count_terms<double>) fmt::print(",p_{}", t.name);
  fmt::print(",best,cs\n");
  std::fprintf(stderr, "%zu workloads\n", all.size());
  for (std::size_t w = from; w < all.size(); w += stride) {
    const auto& one = all[w];
    const Job job = make_regret_job(one, 1, {});
    
    const auto problem = job.problem(); std::vector<Candidate> asked;
    for (int fan : {4, 8, 16}) for (int leaf : {8, 16, 64, 256}) asked.push_back({Technique::box_tree, BoxTreeParameters{fan, leaf}});
    std::vector<model::Ranked> ranking = model::rank(job.workload, built_in_unit_costs()); asked.insert(asked.begin(), ranking.front().candidate);
    if (one.rays > 2e5 || one.samples > 2e5) continue; const auto ex = measure_all(problem, asked);
    for (std::size_t i = 0; i < ex.candidates.size(); ++i) {
      const Timed& t = ex.candidates[i];
      fmt::print("{},{},{},{},{},{},{},{:.3f},{:.4g},{},\"{}\",{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{}", w, one.scene, one.held_out, one.field==sim::Field::photons?"p":"l", job.rays.size(), job.discs.size(), one.radius, job.workload.dimension, sample_distance(job.workload)/job.workload.disc_radius, name(t.candidate.technique), describe(t.candidate), (int)t.abandoned, t.selecting_seconds(), t.judging_seconds(), t.phases.order, t.phases.build, t.phases.search, t.vectors.cull, t.vectors.test);
      for (auto& c : count_terms<std::uint64_t>) fmt::print(",{}", t.counts.*c.term);
      Counts<double> p{};
      try { p = model::assess(job.workload, t.candidate, built_in_unit_costs()).counts; } catch (const std::exception&) {}
      for (auto& c : count_terms<double>) fmt::print(",{:.6g}", p.*c.term);
      fmt::print(",{},{}\n", i == ex.best ? 1 : 0, i == 0 ? ranking.front().time.total() : 0);
    }
    std::fflush(stdout);
    std::fprintf(stderr, "%zu %s %g rays %g d\n", w, one.scene.c_str(), one.rays, one.radius);
  }
}
