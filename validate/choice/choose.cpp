#include "choose.hpp"

#include "detp/model/rank/choose.hpp"

namespace detp::validate {

Candidate choose(std::span<const sim::Ray> rays, std::span<const sim::Disc> discs, const CostTable& costs) {
  return model::rank(measure(sim::make_problem(rays, discs)), costs).front().candidate;
}

Candidate choose(const sim::RaysView& rays, const sim::DiscsView& discs, const CostTable& costs) {
  std::vector<sim::Ray> copied;
  sim::read_rays(rays, copied);
  return choose(copied, sim::read_discs(discs), costs);
}

}  // namespace detp::validate
