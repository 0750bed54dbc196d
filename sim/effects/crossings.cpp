#include "crossings.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "all_effects.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/random.hpp"
#include "sample_groups.hpp"

namespace detp::sim {
namespace {

/// The discs that are looked at, and the shares of uniform rays that cross the spheres around them. Lines have one size
/// of spheres and need fewer discs.
struct Effort {
  std::size_t discs;
  double crossed_around;
  double crossed_near;
};
constexpr Effort for_lines{512, 0.01, 0.01};
constexpr Effort for_segments{4096, 0.003, 0.0003};

/// Whether the ray crosses the disc enlarged to the radius.
bool crosses(const Ray& ray, const Disc& disc, double radius, bool front_facing) {
  const double slope = glm::dot(ray.direction, disc.normal);
  if (slope == 0 || (front_facing && slope > 0)) return false;
  const glm::dvec3 to = disc.centre - ray.origin;
  const double at = glm::dot(to, disc.normal) / slope;
  if (!(at >= (ray.is_line() ? -unbounded : 0) && at <= ray.length)) return false;
  const glm::dvec3 off = at * ray.direction - to;
  return glm::dot(off, off) <= radius * radius;
}

/// What one ray crosses.
struct OfRay {
  double around = 0;
  double near = 0;
  double discs = 0;
};

/// Σ a / Σ b over the rays, in units of `uniform`; the error is that of a quotient of sums (Cochran, Sampling
/// Techniques). 1 if no b was counted.
template <class A, class B>
CountedRatio ratio_of(const std::vector<OfRay>& rays, double uniform, const A& a, const B& b) {
  double above = 0;
  double below = 0;
  for (const OfRay& one : rays) {
    above += a(one);
    below += b(one);
  }
  if (!(below > 0) || rays.size() < 2) return {};
  const double ratio = above / below;
  double squares = 0;
  for (const OfRay& one : rays) {
    const double residual = a(one) - ratio * b(one);
    squares += residual * residual;
  }
  const auto count = static_cast<double>(rays.size());
  return {ratio / uniform, std::sqrt(squares * count / (count - 1)) / below / uniform};
}

/// A measured ratio and the prior knowledge that such ratios are 1 ± 0.5: the mean of both, by the inverse of their variances, and its
/// standard error. The ratio's own standard error is at least `least`, that of rays which are as many as is expected; infinite if
/// nothing was counted, which leaves the prior knowledge.
CountedRatio shrunk(const CountedRatio& ratio, double least) {
  constexpr double spread = 0.5;
  const double error = std::max(ratio.standard_error, least);
  const double trust = 1 / (1 + error / spread * (error / spread));
  return {1 + trust * (ratio.value - 1), spread * std::sqrt(1 - trust)};
}

/// Σ m² over clusters of m of every `step`-th sampled discs, over the square of their number: the square of the relative error of
/// a mean over samples for each expected ray that crosses a cluster, which all rays do alike for all its samples. Clusters are the largest
/// nodes with a radius of at most `reach`.
double unevenness(const EffectSample& sample, std::uint32_t step, double reach) {
  const auto local = static_cast<float>(reach / sample.discs().unit);
  const std::vector<SampledNode>& tree = sample.tree();
  const auto kept_before = [step](std::uint32_t place) { return (place + step - 1) / step; };
  double squares = 0;
  double samples = 0;
  for (std::uint32_t i = 0; i < tree.size();) {
    const SampledNode& node = tree[i];
    const bool is_leaf = node.next == i + 1;
    const bool is_cluster = glm::length(node.high - node.low) <= 2 * local;
    if (is_cluster || is_leaf) {
      const double kept = kept_before(node.end) - kept_before(node.first);
      squares += is_cluster ? kept * kept : kept;
      samples += kept;
    }
    i = is_cluster ? node.next : i + 1;
  }
  return samples > 0 ? squares / (samples * samples) : 0;
}

class CrossingCounter {
 public:
  CrossingCounter(const EffectSample& sample, const Effort& effort)
      : sample_(sample),
        uniform_(sample.uniform()),
        step_(static_cast<std::uint32_t>((sample.discs().discs.size() + effort.discs - 1) / effort.discs)),
        around_(uniform_.radius_for(effort.crossed_around)),
        near_(std::max(sample.problem.radii().rms, uniform_.radius_for(effort.crossed_near))),
        unevenness_(unevenness(sample, step_, around_)),
        unevenness_near_(unevenness(sample, step_, near_)),
        groups_(sample.discs(), sample.tree(), step_, around_, near_) {}

  void count(const Ray& ray) {
    const Problem& problem = sample_.problem;
    OfRay one;
    one.around = groups_.visit_near(ray, [&](std::uint32_t place) {
      one.near += 1;
      const Disc& disc = problem.discs()[sample_.discs().discs[place].number];
      if (crosses(ray, disc, near_, problem.front_facing())) one.discs += 1;
    });
    rays_.push_back(one);
  }

  [[nodiscard]] Crossings crossings() const {
    const auto around = [](const OfRay& ray) { return ray.around; };
    const auto near = [](const OfRay& ray) { return ray.near; };
    const auto discs = [](const OfRay& ray) { return ray.discs; };
    const auto samples = static_cast<double>((sample_.discs().discs.size() + step_ - 1) / step_);
    const double sphere = uniform_.sphere(near_);
    Crossings found;
    found.radius = around_;
    const auto rays = static_cast<double>(rays_.size());
    const double unmet = std::sqrt(unevenness_ / (rays * uniform_.sphere(around_)));
    found.around =
        shrunk(ratio_of(rays_, samples * uniform_.sphere(around_), around, [](const OfRay&) { return 1.0; }), unmet);
    const double unmet_near = std::sqrt(unevenness_near_ / (rays * sphere));
    if (sample_.problem.segments())
      found.near = shrunk(ratio_of(rays_, sphere / uniform_.sphere(around_), near, around), unmet_near);
    // Each ray near a sample crosses its disc with probability p, if rays are isotropic. Discs of one ray are not independent.
    const double p = uniform_.disc(near_, sample_.problem.front_facing()) / sphere;
    const auto rays_near =
        static_cast<double>(std::ranges::count_if(rays_, [](const OfRay& ray) { return ray.near > 0; }));
    found.discs = shrunk(ratio_of(rays_, p, discs, near), std::sqrt((1 - p) / (p * rays_near)));
    return found;
  }

 private:
  const EffectSample& sample_;
  const UniformRays& uniform_;
  std::uint32_t step_;
  double around_;
  double near_;
  double unevenness_;
  double unevenness_near_;
  SampleGroups groups_;
  std::vector<OfRay> rays_;
};

bool is_clear(const CountedRatio& ratio, const Threshold& threshold) {
  return threshold.distance(ratio.value) > 2 * ratio.standard_error;
}

}  // namespace

UniformRays uniform_rays(const Workload& workload) {
  const double d = workload.disc_radius;
  double space = 1;
  for (const double side : workload.box) space *= side + 2 * d;
  return {workload.sphere_radius, workload.path_length, space};
}

Crossings count_crossings(const EffectSample& sample) {
  StopCheck check(sample.stop, "looking for uneven rays");
  const auto rays = stratified_sample(sample.problem.rays().size(), sample.effort.crossing_rays, 2, Stream::evidence);
  CrossingCounter counter(sample, sample.problem.segments() ? for_segments : for_lines);
  for (const std::size_t first : {0, 1}) {  // every second ray, then the others
    for (std::size_t i = first; i < rays.size(); i += 2) {
      check.after(sample.discs().discs.size() / 16);
      counter.count(sample.problem.rays()[rays[i]]);
    }
    const Crossings found = counter.crossings();
    if (is_clear(found.around, uneven_rays.threshold) && is_clear(found.near, occlusion.threshold) &&
        is_clear(found.discs, directional_bias.threshold))
      return found;
  }
  return counter.crossings();
}

}  // namespace detp::sim
