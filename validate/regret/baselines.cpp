#include "baselines.hpp"

#include "detp/model/rank/paper_rule.hpp"
#include "detp/validate/choice/usual_shape.hpp"

namespace detp::validate {
namespace {

std::vector<Candidate> box_trees(const Workload& /*workload*/) {
  std::vector<Candidate> all;
  for (const int fan_out : {4, 8, 16})
    for (const int leaf : {16, 64}) all.push_back({Technique::box_tree, BoxTreeParameters{fan_out, leaf}});
  return all;
}

std::vector<Candidate> usual_box_tree(const Workload& workload) {
  return {{Technique::box_tree, usual_shape(workload.rays, workload.samples)}};
}

std::vector<Candidate> by_paper_rule(const Workload& workload) { return {model::paper_rule(workload)}; }

std::vector<Candidate> embree(const Workload& /*workload*/) {
  return {{Technique::bvh, BvhParameters{BuildQuality::low}}, {Technique::bvh, BvhParameters{BuildQuality::medium}}};
}

std::vector<Candidate> brute_force(const Workload& /*workload*/) { return {default_candidate(Technique::brute_force)}; }

}  // namespace

const std::array<Baseline, 5>& baselines() {
  static const std::array<Baseline, 5> all{{{"best_constant", "best constant", false, box_trees},
                                            {"usual_shape", "usual shape", true, usual_box_tree},
                                            {"paper_rule", "paper's rule", true, by_paper_rule},
                                            {"always_embree", "always Embree", false, embree},
                                            {"always_brute_force", "always brute force", false, brute_force}}};
  return all;
}

}  // namespace detp::validate
