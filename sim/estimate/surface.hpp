#pragma once

#include <memory>

#include "detp/sim/scene/near_triangles.hpp"
#include "detp/sim/search/index.hpp"
#include "estimator.hpp"

namespace detp::sim {

/// The estimators that look at surfaces. Each is an index over the mesh, not over the discs; the mesh must outlive it. `triangles`: of the
/// same mesh, if they are there already. Throws Stopped.

/// Photons over the area of the surfaces that they met:
///
///     E = Σ Φ / A        over landings within the disc's radius d of its centre, on triangles that face as the disc does
///
///   where  A   area of these triangles inside the sphere of radius d
///
/// A triangle faces as the disc does if its normal is within 60° of the disc's, or, where the triangle nearest to the disc is
/// turned round, of the opposite. So a wall is not counted for the floor, and at the floor's edge the area shrinks as the number of
/// photons does. On curved surfaces the area grows. Light that arrives on either side counts, as for discs.
/// Source: H. Hey, W. Purgathofer, "Advanced radiance estimation for photon map global illumination", Eurographics 2002,
/// reduced to a constant kernel.
[[nodiscard]] std::unique_ptr<Index> prepare_area_corrected(const Mesh& mesh, const std::stop_token& stop,
                                                            std::shared_ptr<const NearTriangles> triangles = {});

/// Photons that met the triangles, over their area:
///
///     E_v = Σ_t Φ_t / Σ_t A_t        over the triangles t around vertex v
///     E   = Σ_v b_v E_v              over the corners of the triangle nearest to the disc's centre
///
///   where  b_v  weights of the corners at the point of the triangle nearest to the disc's centre
///
/// Of several triangles at the same distance, the one whose normal is nearest to the disc's. The radius of the discs does not
/// matter. Triangles share a vertex if they name the same one. Those of a scene have one normal each (sim/scene/vertices.hpp), so
/// its edges stay sharp. Sources: J. Arvo, "Backward ray tracing", SIGGRAPH course 1986; S. N. Pattanaik, S. P. Mudur, "Computation of global
/// illumination by Monte Carlo simulation of the particle model of light", 1992.
[[nodiscard]] std::unique_ptr<Index> prepare_triangle_hits(const Mesh& mesh, const std::stop_token& stop,
                                                           std::shared_ptr<const NearTriangles> triangles = {});

/// By the estimator's record. Throws std::invalid_argument for one that does not look at surfaces.
[[nodiscard]] std::unique_ptr<Index> prepare_surfaces(Estimator estimator, const Mesh& mesh,
                                                      const std::stop_token& stop,
                                                      std::shared_ptr<const NearTriangles> triangles = {});

}  // namespace detp::sim
