#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/photons/ray_caster.hpp"
#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// Sums of the paths of one sample.
struct PathSums {
  std::uint64_t paths = 0;  ///< on each side
  double front = 0;
  double back = 0;
  double front_squares = 0;
  double back_squares = 0;
  double largest = 0;       ///< brought by one path
  std::uint64_t lit = 0;    ///< paths that brought light, of both sides
  std::uint64_t casts = 0;  ///< rays that the paths cast

  [[nodiscard]] double irradiance() const { return (front + back) / static_cast<double>(paths); }
  /// Of the mean of the paths.
  [[nodiscard]] double variance() const;
};

/// Irradiance at samples by paths that start at the samples and look for the lights. Nothing is blurred: the estimate has no bias,
/// only variance. A photon's path and a backward path pass the same surfaces with the same probabilities (scatter.hpp), so both
/// estimate the same irradiance: that of both faces, or of the front.
///
///     E = Σ over sides  E_light + π L(ω),  ω by the cosine law
///     L(ω) = E_light(y)/π + L(ω')   at a diffuse surface y      L(ω) = radiance there + L(ω')/n²   else
///
///   where  E_light   irradiance straight from the lights: one point of one light at a time (SeenLights)
///          n         index of refraction behind the surface over that before it, if the path passes through; else 1
///
/// Weak where light comes from points, spots or the sun by way of mirrors, glosses or glass: no backward path meets them, so this light is
/// missing (misses_light).
class BackwardPaths {
 public:
  /// The scene must outlive this. Throws as PhotonTracer does.
  BackwardPaths(const Scene& scene, std::uint64_t seed, const std::stop_token& stop = {});
  /// The same, with a caster of the scene's mesh that was made before (photon_walk.hpp).
  BackwardPaths(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster);
  ~BackwardPaths();

  /// Path number `path` of sample number `number`, on the side of its normal or on the other.
  [[nodiscard]] double irradiance(const Sample& sample, std::uint64_t number, std::uint64_t path, bool front) const;
  /// Adds the sample's paths up to number `paths` - 1 to its sums; with front_facing those of the front alone.
  void add(const Sample& sample, std::uint64_t number, std::uint64_t paths, bool front_facing, PathSums& sums) const;

 private:
  struct Walk;
  std::unique_ptr<const Walk> walk_;
};

/// Whether some light reaches surfaces on ways that no backward path finds.
[[nodiscard]] bool misses_light(const Scene& scene);

/// Adds paths up to number `paths` - 1 of each sample, on all threads of the caller's arena. Samples that a stop request came before
/// keep their sums. With front_facing, only the front counts.
void add_backward_paths(const BackwardPaths& walk, std::span<const Sample> samples, std::uint64_t paths,
                        bool front_facing, std::span<PathSums> sums, const std::stop_token& stop = {});

/// Where a backward path starts, in the caster's own coordinates.
struct StartPlace {
  glm::dvec3 point{0.0};
  std::optional<std::uint32_t> triangle = {};  ///< on which it lies; none: in space
};

/// The places that stand for a sample: one on each triangle within `reach` (in the caster's own units) whose plane is about that of the
/// sample. A sample at a vertex lies on the border of surfaces, and one from a file beside them by a rounding error: a path from there
/// would pass through a surface, or begin behind it. So the places are inside of the triangles, by a thousandth of their size. Without
/// such a triangle: the sample itself.
[[nodiscard]] std::vector<StartPlace> start_places(const RayCaster& caster, const Sample& sample, double reach);

}  // namespace detp::sim
