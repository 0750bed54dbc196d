#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/ranks/ranks.hpp"
#include "detp/sim/rays/ray_source.hpp"
#include "photon_tracer.hpp"

namespace detp::sim {

/// Returns the rays of photon_paths by number, bit for bit the same, without storing them.
///
/// Each photon yields as many rays as its path has pieces. So the constructor traces all photons once, in groups of
/// 1024, and stores the number of rays before each group; ranks share these groups. It also keeps the rays of the groups
/// it traced, as long as they take less than 1/16 of the memory budget. Other groups are traced again when a block needs
/// one of their rays.
class PhotonSource final : public RaySource {
 public:
  /// Throws as photon_paths does.
  PhotonSource(const Scene& scene, std::uint64_t count, std::uint64_t seed, const std::stop_token& stop = {})
      : PhotonSource(scene, count, seed, caster_for(scene, stop), stop) {}
  /// With `ranks`, all of them must make the same source. What one of them throws, the others throw as RankFailed or Stopped.
  PhotonSource(const Scene& scene, std::uint64_t count, std::uint64_t seed, std::shared_ptr<const RayCaster> caster,
               const std::stop_token& stop = {}, Ranks* ranks = nullptr);

  /// The number of rays: at least `count`, to the end of the last photon's path.
  [[nodiscard]] std::uint64_t size() const override { return count_; }
  void read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop = {}) const override;
  [[nodiscard]] bool numbered() const override { return true; }
  [[nodiscard]] std::uint64_t photons() const override { return emitted_; }
  [[nodiscard]] std::uint64_t block_end(std::uint64_t first, std::uint64_t most) const override;
  [[nodiscard]] std::uint64_t first_ray_of(std::uint64_t photon) const override;
  void read_numbered(std::uint64_t first, std::span<Ray> block, std::vector<std::uint64_t>& photons,
                     const std::stop_token& stop = {}) const override;
  [[nodiscard]] double farthest_from(const glm::dvec3& point) const override;
  /// Bytes of rays that a source keeps at most.
  [[nodiscard]] static double most_kept_bytes() { return memory_budget() / 16; }
  /// Of all photons.
  [[nodiscard]] const LightLedger& light() const { return light_; }
  [[nodiscard]] double kept_bytes() const override { return std::min(static_cast<double>(traced_bytes_), most_kept_); }

 private:
  [[nodiscard]] PhotonPieces trace_group(std::uint64_t group, const std::stop_token& stop) const;
  /// The group's rays: those kept, or else `traced`, which it fills.
  const PhotonPieces& pieces_of(std::uint64_t group, PhotonPieces& traced, const std::stop_token& stop) const;
  /// Keeps the pieces if they fit.
  std::unique_ptr<const PhotonPieces> keep(const PhotonPieces& pieces);
  void count_rays(std::uint64_t groups, Ranks& ranks, const std::stop_token& stop);
  /// Number of the group that has the ray.
  [[nodiscard]] std::uint64_t group_of(std::uint64_t ray) const;
  /// Ends at the end of the photon that has ray count_ - 1.
  void end_with_last_photon(const std::stop_token& stop);
  /// Fills in light_ and shares_.
  void add_up_light(const std::stop_token& stop);

  PhotonTracer tracer_;
  std::uint64_t wanted_;
  std::uint64_t count_;
  std::uint64_t limit_;                ///< in photons
  std::vector<std::uint64_t> starts_;  ///< number of each group's first ray; at the end, the number of all rays found
  std::vector<std::unique_ptr<const PhotonPieces>> kept_;  ///< groups; null if not kept
  std::atomic<std::uint64_t> traced_bytes_ = 0;            ///< of groups traced by the constructor
  double most_kept_;                                       ///< in bytes
  Box origins_;
  std::uint64_t emitted_ = 1;         ///< number of photons that yield the rays
  std::vector<LightLedger> ledgers_;  ///< of groups
  LightLedger light_;
  std::vector<double> shares_;  ///< of photons; none: all alike
};

}  // namespace detp::sim
