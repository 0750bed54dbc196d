#pragma once

#include <cstdint>
#include <memory_resource>
#include <numeric>
#include <span>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/curve.hpp"
#include "detp/sim/geometry/hilbert.hpp"
#include "detp/sim/search/hit_collector.hpp"

/// Lists of rays, culled by spheres: shared by all techniques with spheres.
namespace detp::sim {

/// A ray in a list, with its number. Rays are copied, so that a list is read sequentially.
struct ListedRay {
  Ray ray;
  std::uint32_t index;
};

/// The listed rays in rising order of their numbers.
using RayList = std::pmr::vector<ListedRay>;

/// All rays of a problem.
[[nodiscard]] inline RayList list_of(std::span<const Ray> rays, std::pmr::memory_resource* memory) {
  RayList list(memory);
  list.reserve(rays.size());
  for (std::uint32_t i = 0; i < rays.size(); ++i) list.push_back({rays[i], i});
  return list;
}

/// Lists in `inside` the rays of `around` that come within `slack` of the sphere. These include all rays that hit a
/// disc in the sphere, if `around` holds them.
inline void cull(const RayList& around, const Sphere& sphere, double slack, RayList& inside, StopCheck& check) {
  const Sphere grown{sphere.centre, sphere.radius + slack};
  inside.clear();
  inside.reserve(around.size());  // uses pages of memory only as far as the list is filled
  for_each_checked(std::span(around), check, [&](const ListedRay& listed) {
    if (hits(listed.ray, grown)) inside.push_back(listed);
  });
}

/// Tests disc number `index` against the listed rays.
template <bool counting>
void test_disc(const RayList& rays, const Disc& disc, std::uint32_t index, HitCollector& collector,
               Tally<counting>& tally, StopCheck& check) {
  for_each_checked(std::span(rays), check, [&](const ListedRay& listed) {
    if (collector.is_hit(listed.ray, disc)) collector.add_hit(listed.index, index);
  });
  tally.add(&Counts<std::uint64_t>::disc_tests, rays.size());
}

/// Returns the discs' numbers in the given order of the discs' centres; by default along the Morton curve. Throws
/// Stopped if a stop was requested.
[[nodiscard]] inline std::vector<std::uint32_t> along_curve(std::span<const Disc> discs,
                                                            SampleOrder order = SampleOrder::lebesgue,
                                                            const std::stop_token& stop = {}) {
  if (order == SampleOrder::none) {
    std::vector<std::uint32_t> as_given(discs.size());
    std::iota(as_given.begin(), as_given.end(), 0U);
    return as_given;
  }
  std::vector<glm::dvec3> centres;
  centres.reserve(discs.size());
  for (const Disc& disc : discs) centres.push_back(disc.centre);
  return order == SampleOrder::hilbert ? hilbert_order(centres, stop) : lebesgue_order(centres, stop);
}

}  // namespace detp::sim
