#pragma once

#include <vector>

#include "detp/sim/rays/ray_source.hpp"
#include "photon_tracer.hpp"

namespace detp::sim {

/// The rays of photon_paths by their number, bit for bit, without holding them.
///
/// A photon gives as many rays as it has pieces of path. So when made, it traces all photons once, and keeps how many
/// rays there are before each group of 1024 of them; a block that starts amid a group traces that group again and
/// leaves out what comes before. Rays are thus traced twice: once to be counted, once to be read.
class PhotonSource final : public RaySource {
 public:
  /// Throws as photon_paths does.
  PhotonSource(const Scene& scene, std::uint64_t count, std::uint64_t seed, const std::stop_token& stop = {});

  [[nodiscard]] std::uint64_t size() const override { return count_; }
  void read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop = {}) const override;
  [[nodiscard]] double farthest_from(const glm::dvec3& point) const override;

 private:
  [[nodiscard]] PhotonPieces trace_group(std::uint64_t group, const std::stop_token& stop) const;
  void count_rays(std::uint64_t groups, const std::stop_token& stop);
  /// Photons up to the one that gives the last ray.
  [[nodiscard]] std::uint64_t emitted(const std::stop_token& stop) const;

  PhotonTracer tracer_;
  std::uint64_t count_;
  std::uint64_t limit_;                ///< photons
  std::vector<std::uint64_t> starts_;  ///< of each group its first ray's number; then that of all rays found
  Box origins_;
  double power_ = 0;
};

}  // namespace detp::sim
