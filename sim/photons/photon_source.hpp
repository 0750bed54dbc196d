#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/ranks/ranks.hpp"
#include "detp/sim/rays/ray_source.hpp"
#include "photon_rounds.hpp"
#include "photon_tracer.hpp"

namespace detp::sim {

/// When a source counts its rays: all of them before the first is read, or as they are read.
enum class Counting { ahead, as_read };

/// Returns the rays of photon_paths by number, bit for bit the same but for the power, without storing them. The power is that of
/// the photon, to be multiplied by `scale`; if there are fewer than many_photons, it is that of photon_paths, and the scale 1.
///
/// Each photon yields as many rays as its path has pieces. So photons are traced in groups of 1024 to count their rays, and the source stores
/// the number of rays before each group. Counting ahead, the constructor traces all photons, ranks share these groups, and their rays
/// are kept as long as they take less than 1/16 of the memory budget. As they are read, each block_end traces what its block needs, and keeps it
/// until it is read; then there may be one reader at a time. Groups that are not kept are traced again when a block needs one of
/// their rays.
class PhotonSource final : public RaySource {
 public:
  /// Throws as photon_paths does.
  PhotonSource(const Scene& scene, std::uint64_t count, std::uint64_t seed, const std::stop_token& stop = {})
      : PhotonSource(scene, count, seed, caster_for(scene, stop), stop) {}
  /// With `ranks`, all of them must make the same source, and count ahead. What one of them throws, the others throw as RankFailed or Stopped.
  PhotonSource(const Scene& scene, std::uint64_t count, std::uint64_t seed, std::shared_ptr<const RayCaster> caster,
               const std::stop_token& stop = {}, Ranks* ranks = nullptr, Counting counting = Counting::ahead);

  /// The number of rays: at least `count`, to the end of the last photon's path, if that is known.
  [[nodiscard]] std::uint64_t size() const override { return known_->count; }
  void read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop = {}) const override;
  [[nodiscard]] bool numbered() const override { return true; }
  /// If not all are known, those that were traced.
  [[nodiscard]] std::uint64_t photons() const override { return known_->emitted; }
  [[nodiscard]] std::uint64_t photons_of(std::uint64_t rays) const override;
  [[nodiscard]] double scale(std::uint64_t rays) const override;
  [[nodiscard]] std::uint64_t block_end(std::uint64_t first, std::uint64_t most,
                                        const std::stop_token& stop = {}) const override;
  [[nodiscard]] std::uint64_t first_ray_of(std::uint64_t photon) const override;
  [[nodiscard]] std::size_t bands() const override { return tracer_.bands(); }
  void read_all(std::uint64_t first, std::span<Ray> block, BesideRays& beside,
                const std::stop_token& stop = {}) const override;
  [[nodiscard]] double farthest_from(const glm::dvec3& point) const override;
  /// Bytes of rays that a source keeps at most if it counts ahead.
  [[nodiscard]] static double most_kept_bytes() { return memory_budget() / 16; }
  [[nodiscard]] double kept_bytes(std::size_t block) const override;
  /// Of the first photons.
  [[nodiscard]] LightLedger light_of(std::uint64_t photons) const;

 private:
  /// What tracing has shown so far.
  struct Known {
    PhotonRounds rounds;
    std::vector<std::uint64_t> starts{
        0};  ///< number of each group's first ray; at the end, the number of all rays found
    std::vector<std::unique_ptr<const PhotonPieces>> kept;  ///< groups; null if not kept
    std::vector<LightLedger> ledgers;                       ///< of groups
    std::atomic<std::uint64_t> kept_bytes = 0;
    std::uint64_t photons = 0;  ///< to be traced by all rounds so far
    std::uint64_t count;
    std::uint64_t emitted = 0;  ///< number of photons that yield the rays
    bool all = false;
    std::vector<double> shares = {};  ///< of photons; none: all alike
  };

  [[nodiscard]] PhotonPieces trace_group(std::uint64_t group, const std::stop_token& stop) const;
  /// The group's rays: those kept, or else `traced`, which it fills.
  const PhotonPieces& pieces_of(std::uint64_t group, PhotonPieces& traced, const std::stop_token& stop) const;
  /// Keeps the pieces if they fit, or are to be read.
  std::unique_ptr<const PhotonPieces> keep(const PhotonPieces& pieces) const;
  /// Traces until so many rays are known, or all.
  void know(std::uint64_t rays, Ranks& ranks, const std::stop_token& stop) const;
  void count_rays(std::uint64_t groups, Ranks& ranks, const std::stop_token& stop) const;
  /// Number of the group that has the ray.
  [[nodiscard]] std::uint64_t group_of(std::uint64_t ray) const;
  /// Ends at the end of the photon that has the last ray wanted, and finds the photons' shares.
  void end_with_last_photon(const std::stop_token& stop) const;

  PhotonTracer tracer_;
  Counting counting_;
  std::uint64_t wanted_;
  double most_kept_;  ///< in bytes
  Box origins_;
  std::unique_ptr<Known> known_;
};

}  // namespace detp::sim
