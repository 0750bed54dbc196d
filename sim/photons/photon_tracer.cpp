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
    if (kept.further_bands > 0) {
      kept.rays.back().power = ray.power * now.r;
      kept.further.insert(kept.further.end(), {ray.power * now.g, ray.power * now.b});
    }
    kept.landings.push_back(landing);
    kept.triangles.push_back(no_triangle);
  }
  void met(std::uint32_t triangle, double, bool) { kept.triangles.back() = triangle; }
  /// What a photon loses between two pieces, it leaves on a surface.
  void tint(const glm::dvec3& next) {
    if (is_new) first = next;
    if (!is_new) deposited += now - next;
    is_new = false;
    now = next;
  }

  void begin() {
    is_new = true;
    deposited = glm::dvec3(0.0);
  }
  /// The ledger of a photon that ended so.
  [[nodiscard]] std::array<BandLedger, 3> bands(PathEnd end, double power) const {
    std::array<BandLedger, 3> all;
    for (int band = 0; band < 3; ++band) {
      BandLedger& one = all[static_cast<std::size_t>(band)];
      one = {.emitted = power * first[band], .deposited = power * deposited[band]};
      if (end == PathEnd::left || end == PathEnd::missed) one.left = power * now[band];
      if (end == PathEnd::cut) one.cut = power * now[band];
    }
    return all;
  }

  glm::dvec3 first{1.0}, now{1.0}, deposited{0.0};
  bool is_new = true;
};

}  // namespace

PhotonTracer::PhotonTracer(const Scene& scene, std::uint64_t seed, const std::stop_token& stop)
    : walk_(scene, seed, stop) {}

PhotonTracer::PhotonTracer(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster)
    : walk_(scene, seed, std::move(caster)) {}

PhotonPieces PhotonTracer::trace(std::uint64_t first, std::uint64_t last, const std::stop_token& stop,
                                 std::uint64_t most) const {
  const auto piece_bytes =
      static_cast<double>(bytes_of_ray_in(bands()) + sizeof(std::uint64_t) + sizeof(double) + sizeof(std::uint32_t));
  constexpr std::uint64_t many = std::uint64_t{1} << 20;
  StopCheck check(stop, "tracing photons");
  check.now();
  PhotonPieces pieces;
  pieces.further_bands = bands() - 1;
  Pieces recorder{pieces, check};
  for (std::uint64_t photon = first; photon < last && pieces.rays.size() < most; ++photon) {
    recorder.begin();
    pieces.ends.push_back(walk_.follow(photon, recorder));
    if (bands() > 1) pieces.bands.push_back(recorder.bands(pieces.ends.back(), power(photon)));
    if (pieces.rays.size() > many)
      require_memory("photon paths that hardly end", 2 * piece_bytes * static_cast<double>(pieces.rays.size()));
    pieces.photons.resize(pieces.rays.size(), photon);
    check.after(work_of_a_bounce);
  }
  pieces.photon_count = first + pieces.ends.size();
  return pieces;
}

}  // namespace detp::sim
