#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

/// A competitor of our techniques: all hits by Embree, in single precision.
///
/// No other library is measured. nanoflann finds points near points: each line would have to be covered by balls, and
/// discs found more than once would have to be removed. CGAL's tree of boxes could hold discs in double precision, but
/// requires GMP and MPFR and uses no SIMD, so it would not be the fastest on any workload.
namespace detp::validate {

/// A filter rejects every hit, so both kinds of query visit every hit. The queries differ in the order of visiting
/// nodes (nearest first, or any order) and in what a ray stores.
enum class EmbreeQuery { intersect, occluded };

/// Number and form of the rays in a call.
enum class EmbreeRays {
  one,               ///< rtcIntersect1
  packet_8,          ///< rtcIntersect8
  packet_16,         ///< rtcIntersect16
  stream_of_rays,    ///< rtcIntersect1M, 64 rays
  stream_of_packets  ///< rtcIntersectNM, 8 packets of 8
};

enum class EmbreeQuality { low, medium, high };

struct EmbreeMode {
  EmbreeQuery query = EmbreeQuery::intersect;
  EmbreeRays rays = EmbreeRays::one;
  EmbreeQuality quality = EmbreeQuality::medium;
  bool coherent = false;  ///< RTC_INTERSECT_CONTEXT_FLAG_COHERENT
  bool operator==(const EmbreeMode&) const = default;
};

/// The name of the function called: "rtcIntersect8".
[[nodiscard]] std::string call_of(const EmbreeMode& mode);

/// "low", "medium" or "high".
[[nodiscard]] std::string name(EmbreeQuality quality);

/// "rtcIntersect8, low, coherent".
[[nodiscard]] std::string describe(const EmbreeMode& mode);

/// All modes: 60 of Embree 3, 36 of Embree 4, which has no streams of rays, and none if this build has no Embree.
[[nodiscard]] std::vector<EmbreeMode> all_embree_modes();

/// Embree's results for each disc.
struct PeerOutcome {
  std::vector<std::uint64_t> hits;
  std::vector<double> irradiance;  ///< power of the hits divided by π d²
  bool stopped = false;            ///< true if the run was stopped: the results are partial
};

/// Embree 3 or 4, used as its documentation advises: RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT, hits collected by the context's
/// filter, denormals flushed to zero, aligned rays written in single stores, coherent streams of 64. Decides hits in
/// single precision, so rounding may make hits near a disc's rim wrong.
///
/// The constructor makes the device and starts its threads, so that timed runs do not include this.
class EmbreePeer {
 public:
  /// `instruction_set` is one of ours; empty: all that the machine has. Throws
  /// std::invalid_argument for one of which Embree has no counterpart, and std::runtime_error if this build has no Embree.
  explicit EmbreePeer(int threads, const std::string& instruction_set = {});
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  /// Computes irradiance in memory from discs and rays in memory: converts to single precision, builds, and traces. The
  /// rays are divided among the threads; each thread has its own sums. Throws std::bad_alloc or std::runtime_error if
  /// Embree fails.
  [[nodiscard]] PeerOutcome run(std::span<const sim::Ray> rays, std::span<const sim::Disc> discs,
                                const EmbreeMode& mode, const std::stop_token& stop = {}) const;

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

}  // namespace detp::validate
