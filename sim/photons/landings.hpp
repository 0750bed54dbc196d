#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/paths.hpp"
#include "detp/sim/scene/mesh.hpp"
#include "ray_caster.hpp"

/// Photons that another program traced, on the surface of a scene.
namespace detp::sim {

/// What became of photons' landings, in rays.
struct LandingCounts {
  std::uint64_t on_surface = 0;   ///< the ray lands on a triangle
  std::uint64_t crossing = 0;     ///< of these: not at its end, but where it first crosses the surface
  std::uint64_t elsewhere = 0;    ///< it lands, or ends, where no triangle is
  std::uint64_t nowhere = 0;      ///< by its file it lands nowhere
  std::uint64_t without_end = 0;  ///< a line, of which the file does not say where it lands

  [[nodiscard]] std::uint64_t all() const { return on_surface + elsewhere + nowhere + without_end; }
};

/// Points this close to the surface are on it: a share of the diagonal of the mesh's box. Files have rounded numbers.
inline constexpr double surface_tolerance = 1e-4;

/// Finds the triangle on which each photon landed (PathRays::triangles), and its landing, if `given` is false: at the ray's end,
/// if the surface is there, else where the ray first crosses it. Landings that are given stay; their triangle is the nearest that the ray crosses there. A ray that
/// lands where no triangle is has no triangle, and no landing unless it was given. Lines without end have none. The result does not depend on the number of threads. Throws Stopped.
LandingCounts land(Paths& paths, bool given, const RayCaster& caster, const Box& box, int threads = 1,
                   const std::stop_token& stop = {});

/// Photons as photon maps have them: the origin of each ray is where the photon landed, its direction that of the flight. Makes of
/// each the piece of the path that ended there, as photon_paths does: from the surface before it, or from beyond the box, to a little beyond the landing, by
/// `overshoot` at most. Throws std::invalid_argument for rays that have a length, and Stopped.
LandingCounts make_pieces(Paths& paths, const RayCaster& caster, const Box& box, double overshoot, int threads = 1,
                          const std::stop_token& stop = {});

/// What a user should know of the counts; empty if all is well.
[[nodiscard]] std::string landing_notice(const LandingCounts& counts);

}  // namespace detp::sim
