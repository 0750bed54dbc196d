#include "photon_tracer.hpp"

#include <utility>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t work_of_a_bounce = 64;  // for StopCheck: a bounce takes microseconds

/// Keeps the pieces.
struct Pieces {
  PhotonPieces& kept;
  StopCheck& check;

  void piece(const Ray& ray, double landing) {
    check.after(work_of_a_bounce);
    kept.rays.push_back(ray);
    kept.landings.push_back(landing);
    kept.triangles.push_back(no_triangle);
  }
  void met(std::uint32_t triangle, double, bool) { kept.triangles.back() = triangle; }
};

}  // namespace

PhotonTracer::PhotonTracer(const Scene& scene, std::uint64_t seed, const std::stop_token& stop)
    : walk_(scene, seed, stop) {}

PhotonTracer::PhotonTracer(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster)
    : walk_(scene, seed, std::move(caster)) {}

PhotonPieces PhotonTracer::trace(std::uint64_t first, std::uint64_t last, const std::stop_token& stop,
                                 std::uint64_t most) const {
  constexpr double piece_bytes = sizeof(Ray) + sizeof(std::uint64_t) + sizeof(double) + sizeof(std::uint32_t);
  constexpr std::uint64_t many = std::uint64_t{1} << 20;
  StopCheck check(stop, "tracing photons");
  check.now();
  PhotonPieces pieces;
  Pieces recorder{pieces, check};
  for (std::uint64_t photon = first; photon < last && pieces.rays.size() < most; ++photon) {
    pieces.ends.push_back(walk_.follow(photon, recorder));
    if (pieces.rays.size() > many)
      require_memory("photon paths that hardly end", 2 * piece_bytes * static_cast<double>(pieces.rays.size()));
    pieces.photons.resize(pieces.rays.size(), photon);
    check.after(work_of_a_bounce);
  }
  pieces.photon_count = first + pieces.ends.size();
  return pieces;
}

}  // namespace detp::sim
