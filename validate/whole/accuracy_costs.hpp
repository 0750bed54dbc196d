#pragma once

#include <cstddef>

#include "detp/sim/estimate/estimate.hpp"

/// What tracing and estimating takes, from counts and stored unit costs: the same seconds on a busy machine.
namespace detp::validate {

/// Seconds that grow with the number of rays n: fixed + per_ray n + per_ray_squared n².
struct GrowingSeconds {
  double fixed = 0;
  double per_ray = 0;
  double per_ray_squared = 0;  ///< of nearest, whose k grows with n

  [[nodiscard]] double at(double rays) const { return fixed + (per_ray + per_ray_squared * rays) * rays; }
  /// The rays that take so many seconds; at least 1.
  [[nodiscard]] double rays_in(double seconds) const;
};
[[nodiscard]] GrowingSeconds operator+(const GrowingSeconds& a, const GrowingSeconds& b);

/// What a pilot counts of a setting.
struct SettingCounts {
  double hits_per_ray = 0;      ///< of pairs, or of what stands for them, at all samples
  double radius_over_edge = 0;  ///< the discs' radius over the mean edge of the mesh
  double nearest_per_ray = 0;   ///< k over the number of rays
};

/// Unit costs are those of two virtual cores of an AMD EPYC (Zen 3, AVX2), measured in six built-in scenes with 2·10⁴ to 10⁶ rays; those of
/// tracing and reading of an AMD EPYC (Zen 5), five built-in scenes and four meshes of 60 000 to 450 000 triangles. A stored calibration scales them by its
/// box tree's.
class AccuracyCosts {
 public:
  /// `threads`: 0: all cores.
  AccuracyCosts(std::size_t triangles, int threads);

  /// Tracing, with what is built for it.
  [[nodiscard]] GrowingSeconds trace() const;
  /// Estimating at so many samples, with what is built of the mesh.
  [[nodiscard]] GrowingSeconds estimate(sim::Estimator estimator, double samples, const SettingCounts& counts) const;
  /// Building what estimators need of the mesh: once for all runs.
  [[nodiscard]] double surfaces(sim::Estimator estimator) const;
  /// One backward path, on each side, that casts so many rays. In ten scenes, 0.7 to 1.6 times as long: most where rays graze fine surfaces.
  [[nodiscard]] double path(double casts) const;
  /// Building what traces rays.
  [[nodiscard]] double caster() const;
  /// Making lines of a field.
  [[nodiscard]] GrowingSeconds lines() const;
  /// Reading so many bytes of text and of numbers, or making a built-in scene, with what is made of the mesh, and so many discs.
  [[nodiscard]] double read(double text_bytes, double binary_bytes, double discs) const;
  /// On one thread, what takes so many microseconds where the unit costs were measured.
  [[nodiscard]] double on_one_thread(double microseconds) const { return unit_of_one_ * microseconds; }

 private:
  double triangles_;
  double unit_;         ///< seconds of a microsecond's work there
  double unit_of_one_;  ///< the same on one thread
};

}  // namespace detp::validate
