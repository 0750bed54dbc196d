#include <cmath>
#include <numbers>

#include "built_in.hpp"
#include "mesh_pieces.hpp"

namespace detp::sim::built_in {

LitMesh sunlit() {
  constexpr double cell = 1.0 / 32;
  constexpr double cosine = 0.8;
  const double beam_radius =
      (1 + 1e-6) * std::sqrt(0.5);  // of the sphere around the box, as of every directional light
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  add_quad(mesh, {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}}, cell);
  mesh.materials.all = {{.name = "floor", .diffuse = 0.5}};
  paint(mesh, 0);
  lit_mesh.lights = {{DirectionalLight{{0.6, -cosine, 0}}, std::numbers::pi * beam_radius * beam_radius / cosine}};
  lit_mesh.known_irradiance = 1;
  return lit_mesh;
}

}  // namespace detp::sim::built_in
