#include "paper_rule.hpp"

#include <algorithm>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"

namespace detp::model {

Candidate paper_rule(const Valid<Workload>& workload, const ProcessorCache& cache) {
  require_positive("size of the processor's cache", cache.bytes);
  require_positive("bytes of a ray", cache.bytes_per_ray);
  const DiscRadius d{workload.disc_radius};
  const std::int64_t k =
      std::max<std::int64_t>(1, sphere_count(Form::corrected, {published_ratio}, d, {workload.sphere_radius}));
  const Candidate spheres{Technique::sphere_cache, SphereCacheParameters{published_ratio, k, SampleOrder::lebesgue}};
  const Candidate index{Technique::octree,
                        OctreeParameters{std::min(20, published::octree_depth(d, scene_side(workload)))}};
  const double x = sample_distance(workload) / workload.disc_radius;
  if (x <= 2) return index;
  if (x >= 6) return spheres;
  const double inner_bytes = published::rays_in_sphere(workload.rays, {published_ratio}, k) * cache.bytes_per_ray;
  return inner_bytes <= cache.bytes ? spheres : index;
}

}  // namespace detp::model
