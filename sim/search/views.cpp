#include "views.hpp"

#include "detp/sim/base/floating_point.hpp"
#include "soundness.hpp"

namespace detp::sim {
namespace {

glm::dvec3 vector_at(const VectorsView& view, std::size_t i) { return {view.at(i, 0), view.at(i, 1), view.at(i, 2)}; }

}  // namespace

void read_rays(const RaysView& view, std::vector<Ray>& rays) {
  const DefaultFloatingPoint mode;
  rays.resize(view.count);
  for (std::size_t i = 0; i < view.count; ++i)
    rays[i] =
        normalised(Ray{vector_at(view.origins, i), vector_at(view.directions, i), view.lengths[i], view.powers[i]});
}

std::vector<Disc> read_discs(const DiscsView& view) {
  const DefaultFloatingPoint mode;
  std::vector<Disc> discs(view.count);
  for (std::size_t i = 0; i < view.count; ++i)
    discs[i] = normalised(Disc{vector_at(view.centres, i), vector_at(view.normals, i), view.radii[i]});
  return discs;
}

}  // namespace detp::sim
