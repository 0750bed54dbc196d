#include "photon_paths.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/directions.hpp"
#include "detp/sim/random.hpp"
#include "emitter.hpp"
#include "ray_caster.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t block_size = 256;              // photons that one thread traces at a time
constexpr std::uint64_t most_in_a_round = 1ULL << 20;  // photons
constexpr std::uint64_t most_pieces = 1000;            // of one photon: an albedo of 1 must come to an end
constexpr double gap_share = 1e-5;                     // of the box's diagonal

/// The pieces of some photons, in order, each with the number of its photon.
struct Pieces {
  std::vector<Ray> rays;
  std::vector<std::uint64_t> photons;
};

/// Checks first, so that nothing else need cope with what cannot be traced.
const Scene& checked(const Scene& scene) {
  if (!scene.light) throw std::invalid_argument("photon paths need a light; " + scene.name + " has none");
  if (scene.mesh.triangles.empty())
    throw std::invalid_argument("photon paths need triangles; " + scene.name + " has none");
  if (!(scene.albedo >= 0 && scene.albedo <= 1))
    throw std::invalid_argument("albedo must be in [0, 1] (got " + std::to_string(scene.albedo) + ")");
  if (scene.box.empty())
    throw std::invalid_argument("photon paths need the scene's box; that of " + scene.name + " is empty");
  const glm::dvec3 size = scene.box.size();
  require_positive("diagonal of the scene's box", std::hypot(size.x, size.y, size.z));
  return scene;
}

/// Traces photons in the ray caster's own coordinates.
class Tracer {
 public:
  Tracer(const Scene& scene, std::uint64_t seed)
      : caster_(checked(scene).mesh, scene.box), emitter_(*scene.light), albedo_(scene.albedo), seed_(seed) {
    const glm::dvec3 size = scene.box.size() / caster_.scale();
    reach_ = glm::length(size);
    gap_ = gap_share * reach_;
  }

  /// Photons first … last - 1.
  [[nodiscard]] Pieces trace(std::uint64_t first, std::uint64_t last) const {
    Pieces pieces;
    for (std::uint64_t photon = first; photon < last; ++photon) {
      add_path(photon, pieces.rays);
      pieces.photons.resize(pieces.rays.size(), photon);
    }
    return pieces;
  }

 private:
  void add_path(std::uint64_t photon, std::vector<Ray>& rays) const {
    Departure from = emitter_.photon(uniform4(seed_, Stream::photons, photon));
    from.origin = caster_.to_own(from.origin);
    std::optional<std::uint32_t> triangle;
    for (std::uint64_t bounce = 1; bounce <= most_pieces; ++bounce) {
      const auto meeting = caster_.first_meeting(from.origin, from.direction, triangle);
      if (!meeting) return add_last_piece(from, rays);
      rays.push_back(piece(from, meeting->distance, gap_));
      const auto random = uniform4(seed_, Stream::photons, photon, bounce);
      if (!(random[0] < albedo_)) return;
      const glm::dvec3 normal = glm::dot(meeting->normal, from.direction) < 0 ? meeting->normal : -meeting->normal;
      from.origin += meeting->distance * from.direction;
      from.direction = cosine_direction(normal, random[1], random[2]);
      triangle = meeting->triangle;
    }
  }

  /// Of a photon that leaves the scene.
  void add_last_piece(const Departure& from, std::vector<Ray>& rays) const {
    const double along = glm::dot(from.origin, from.direction);
    const double inside = reach_ * reach_ - glm::dot(from.origin, from.origin);
    if (inside > 0) rays.push_back(piece(from, std::sqrt(along * along + inside) - along, 0));
  }

  [[nodiscard]] Ray piece(const Departure& from, double distance, double beyond) const {
    const double start = std::min(gap_, 0.5 * distance);
    return {.origin = caster_.to_scene(from.origin + start * from.direction),
            .direction = from.direction,
            .length = caster_.scale() * (distance - start + beyond)};
  }

  RayCaster caster_;
  Emitter emitter_;
  double albedo_;
  std::uint64_t seed_;
  double reach_ = 0;  ///< radius of the sphere around the box where photons leave, own units
  double gap_ = 0;    ///< own units
};

std::vector<Pieces> trace_round(const Tracer& tracer, std::uint64_t first, std::uint64_t photons) {
  std::vector<Pieces> blocks((photons + block_size - 1) / block_size);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const std::uint64_t start = first + i * block_size;
    blocks[i] = tracer.trace(start, std::min(start + block_size, first + photons));
  });
  return blocks;
}

/// How many photons to trace next: about as many as give the missing pieces, as far as is known from those traced. It
/// decides how much is traced in vain, not what comes out.
std::uint64_t round_size(std::size_t missing, std::size_t found, std::uint64_t traced) {
  if (traced == 0) return std::clamp<std::uint64_t>(missing / 4, block_size, most_in_a_round);
  const double each = static_cast<double>(found) / static_cast<double>(traced);
  const double wanted = each > 0 ? 1.02 * static_cast<double>(missing) / each : 2.0 * static_cast<double>(traced);
  const double most = static_cast<double>(most_in_a_round);
  return std::max(block_size, static_cast<std::uint64_t>(std::min(wanted, most)));
}

}  // namespace

std::vector<Ray> photon_paths(const Scene& scene, std::size_t count, std::uint64_t seed) {
  const Tracer tracer(scene, seed);
  const std::uint64_t limit = 1000 + 100 * static_cast<std::uint64_t>(count);
  std::vector<Ray> rays;
  std::uint64_t traced = 0;
  std::uint64_t emitted = 1;
  while (rays.size() < count) {
    if (traced >= limit)
      throw std::invalid_argument(
          "the light of " + scene.name + " hardly meets its surfaces: " + std::to_string(traced) + " photons gave " +
          std::to_string(rays.size()) + " pieces of path (" + std::to_string(count) + " asked for)");
    const std::uint64_t photons = std::min(round_size(count - rays.size(), rays.size(), traced), limit - traced);
    for (const Pieces& block : trace_round(tracer, traced, photons)) {
      const std::size_t taken = std::min(block.rays.size(), count - rays.size());
      if (taken == 0) continue;
      rays.insert(rays.end(), block.rays.begin(), block.rays.begin() + static_cast<std::ptrdiff_t>(taken));
      emitted = block.photons[taken - 1] + 1;
    }
    traced += photons;
  }
  for (Ray& ray : rays) ray.power = 1 / static_cast<double>(emitted);
  return rays;
}

}  // namespace detp::sim
