#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "embree_mode.hpp"

/// The alternative that a user has: all hits by Embree, in its single precision.
///
/// No other peer is measured. nanoflann finds points near points: lines would have to be cut into balls, and discs
/// found twice removed. CGAL's tree of boxes could hold discs in double precision, but requires GMP and MPFR and has
/// neither packets nor SIMD: it would not be the fastest option on any workload.
namespace detp::validate {

/// A peer's result for each disc.
struct PeerOutcome {
  std::vector<std::uint64_t> hits;
  std::vector<double> irradiance;  ///< power over π d²
  bool stopped = false;            ///< true if the run was stopped: the results are partial
};

/// Embree 3, used as its documentation advises: RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT, hits collected by the context's
/// filter, denormals flushed to zero, aligned rays written in single stores, coherent streams of 64. Decides hits in
/// single precision: a hit near a disc's rim may be wrong by rounding.
///
/// The constructor makes the device and starts its threads, so this is not part of a timed run.
class EmbreePeer {
 public:
  explicit EmbreePeer(int threads);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  /// From discs and rays in memory to irradiance in memory: converts to single precision, builds, and traces. Rays are
  /// split over the threads; each thread has its own sums. Throws std::runtime_error if Embree fails.
  [[nodiscard]] PeerOutcome run(std::span<const sim::Ray> rays, std::span<const sim::Disc> discs,
                                const EmbreeMode& mode, const std::stop_token& stop = {}) const;

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

}  // namespace detp::validate
