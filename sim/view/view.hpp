#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/photons/ray_caster.hpp"
#include "detp/sim/scene/mesh.hpp"
#include "detp/sim/scene/up.hpp"

/// What is seen of a mesh from a place.
namespace detp::sim {

struct View {
  glm::dvec3 from{0.0};
  glm::dvec3 to{0.0};            ///< in the middle of the picture
  glm::dvec3 up{0.0, 1.0, 0.0};  ///< in the picture; not parallel to the line of sight
  double half_height = 0.4;      ///< of what is seen at the distance 1; of a plan in scene units
  bool plan = false;             ///< lines of sight are parallel
  double aspect = 4.0 / 3;       ///< width over height of the picture
};

/// From one place to another, with the scene's direction up, or another if that is the line of sight. Throws std::invalid_argument if
/// the places are the same or not finite.
[[nodiscard]] View view_between(const glm::dvec3& from, const glm::dvec3& to, const Up& up);

/// A point of a surface that is worth seeing.
struct Sight {
  glm::dvec3 place{0.0};
  glm::dvec3 normal{0.0};  ///< unit length
  double weight = 1;
};

/// The view that sees the most of the sights, each by its weight and the cosine at which it is seen: from 36 places around the mesh, and 8
/// places within it, which are preferred if they see more by a quarter. A scene whose box is flat (the thinnest side below 2 % of the next) is seen as a plan. Looks at some 500 of the sights. The mesh is not a point. Throws Stopped.
[[nodiscard]] View view_of_most(const RayCaster& caster, const Mesh& mesh, const Up& up, std::span<const Sight> sights,
                                const std::stop_token& stop = {});

/// What a line of sight meets.
struct Seen {
  static constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t triangle = nothing;
  double second = 0;  ///< weights of the triangle's second and third corner (barycentric coordinates)
  double third = 0;
  double depth = unbounded;  ///< along the middle line of sight

  [[nodiscard]] bool anything() const { return triangle != nothing; }
};

/// Cells of a picture, which are squares.
struct Cells {
  int width;
  int height;

  /// About so many, in the shape of the view.
  Cells(const View& view, double count);
  /// Both sides are multiples of this.
  static constexpr int step = 2;
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// What lines of sight through the middles of the cells meet, row by row from the top left. Throws Stopped.
[[nodiscard]] std::vector<Seen> look(const RayCaster& caster, const Mesh& mesh, const View& view, const Cells& cells,
                                     int threads, const std::stop_token& stop = {});

/// Cells at the edge of a surface, or where it is bent by more than 30 degrees: a cell behind its neighbour is marked.
[[nodiscard]] std::vector<char> outlines(std::span<const Seen> seen, const Mesh& mesh, const View& view,
                                         const Cells& cells);

}  // namespace detp::sim
