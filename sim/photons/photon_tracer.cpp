#include "photon_tracer.hpp"

#include <utility>

#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t work_of_a_bounce = 64;  // for StopCheck: a bounce takes microseconds

/// Keeps the pieces.
struct Pieces {
  PhotonPieces& kept;

  void piece(const Ray& ray, double landing) {
    kept.rays.push_back(ray);
    kept.landings.push_back(landing);
    kept.triangles.push_back(no_triangle);
  }
  void met(std::uint32_t triangle, double, bool) { kept.triangles.back() = triangle; }
  void escaped(double) {}
  void cut_off(double) {}
};

}  // namespace

PhotonTracer::PhotonTracer(const Scene& scene, std::uint64_t seed, const std::stop_token& stop)
    : walk_(scene, seed, stop) {}

PhotonTracer::PhotonTracer(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster)
    : walk_(scene, seed, std::move(caster)) {}

PhotonPieces PhotonTracer::trace(std::uint64_t first, std::uint64_t last, const std::stop_token& stop) const {
  StopCheck check(stop, "tracing photons");
  check.now();
  PhotonPieces pieces;
  Pieces recorder{pieces};
  for (std::uint64_t photon = first; photon < last; ++photon) {
    walk_.follow(photon, recorder);
    const std::size_t bounces = pieces.rays.size() - pieces.photons.size() + 1;
    pieces.photons.resize(pieces.rays.size(), photon);
    check.after(work_of_a_bounce * bounces);
  }
  pieces.photon_count = last;
  return pieces;
}

}  // namespace detp::sim
