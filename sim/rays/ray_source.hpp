#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/geometry/paths.hpp"
#include "line_field.hpp"

/// Sources that return rays by number, so that only one block of rays needs to be in memory at a time.
namespace detp::sim {

/// What comes with rays: their photons' numbers, and a row of powers in further bands for each (FurtherPowers); empty if there are none.
struct BesideRays {
  std::vector<std::uint64_t> photons = {};
  std::vector<double> further = {};
};

/// A sequence of rays. Each is a function of its number alone: every read of a ray returns the same bytes, whichever
/// block it is in.
class RaySource {
 public:
  virtual ~RaySource() = default;

  /// Number of rays. A source that makes them as they are read knows it when block_end has come to the last; until then it is what was
  /// asked for, which is not more.
  [[nodiscard]] virtual std::uint64_t size() const = 0;

  /// Fills the block with the rays first, first + 1, …. Callers must not read beyond the last ray. May use oneTBB's
  /// threads. Throws Stopped if a stop was requested; the block's contents are then unspecified.
  virtual void read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop = {}) const = 0;

  /// True if rays are pieces of photon paths, and have the numbers of their photons. If not, each ray is a photon.
  [[nodiscard]] virtual bool numbered() const { return false; }
  /// Number of photons emitted: those of all rays, and those that gave none.
  [[nodiscard]] virtual std::uint64_t photons() const { return size(); }
  /// Number of photons emitted until the first `rays` rays were there; photons() for all rays.
  [[nodiscard]] virtual std::uint64_t photons_of(std::uint64_t rays) const {
    return numbered() ? photons() : std::min(rays, size());
  }
  /// What the powers of the first `rays` rays are to be multiplied by: 1, or for pieces of photon paths that come with the powers of their
  /// photons, 1 over the number of these.
  [[nodiscard]] virtual double scale(std::uint64_t) const { return 1; }
  /// The largest end of a block that begins at ray `first`, has at most `most` rays, and does not split a photon; if the
  /// first photon alone has more rays, the end of that photon. Throws as `read`.
  [[nodiscard]] virtual std::uint64_t block_end(std::uint64_t first, std::uint64_t most,
                                                const std::stop_token& = {}) const {
    return std::min(size(), first + most);
  }
  /// Number of the first ray of this photon or a later one; size() if there is none.
  [[nodiscard]] virtual std::uint64_t first_ray_of(std::uint64_t photon) const { return std::min(size(), photon); }
  /// Number of powers of each ray.
  [[nodiscard]] virtual std::size_t bands() const { return 1; }
  /// Reads rays with all that comes with them. Throws as `read`.
  virtual void read_all(std::uint64_t first, std::span<Ray> block, BesideRays& beside,
                        const std::stop_token& stop = {}) const {
    beside = {};
    read(first, block, stop);
  }

  /// An upper bound on the distance of any ray's origin from the point.
  [[nodiscard]] virtual double farthest_from(const glm::dvec3& point) const = 0;

  /// Bytes of rays that the source keeps, so that it need not make them again, while blocks of so many rays are read.
  [[nodiscard]] virtual double kept_bytes(std::size_t) const { return 0; }
};

/// An upper bound on the distance of any point in the box from this one.
[[nodiscard]] inline double farthest_in(const Box& box, const glm::dvec3& point) {
  constexpr double rounding = 1 + 1e-12;
  return rounding * glm::length(glm::max(glm::abs(box.low - point), glm::abs(box.high - point)));
}

/// Rays in memory. They are not copied, and must outlive the source. read() does not check for a stop request.
class RaysInMemory final : public RaySource {
 public:
  explicit RaysInMemory(std::span<const Ray> rays, const FurtherPowers& further = {})
      : rays_(rays), further_(further) {}

  [[nodiscard]] std::uint64_t size() const override { return rays_.size(); }
  void read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop = {}) const override;
  [[nodiscard]] std::size_t bands() const override { return 1 + further_.bands; }
  void read_all(std::uint64_t first, std::span<Ray> block, BesideRays& beside,
                const std::stop_token& stop = {}) const override;
  [[nodiscard]] double farthest_from(const glm::dvec3& point) const override;

 private:
  std::span<const Ray> rays_;
  FurtherPowers further_;
};

/// The first `count` lines of a field.
class LinesOfField final : public RaySource {
 public:
  LinesOfField(const Sphere& sphere, std::uint64_t seed, std::uint64_t count)
      : field_(sphere, seed), sphere_(sphere), count_(count) {}

  [[nodiscard]] std::uint64_t size() const override { return count_; }
  void read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop = {}) const override;
  [[nodiscard]] double farthest_from(const glm::dvec3& point) const override;

 private:
  LineField field_;
  Sphere sphere_;
  std::uint64_t count_;
};

}  // namespace detp::sim
