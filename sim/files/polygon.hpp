#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Removes corners of a polygon of more than three that follow themselves, as where an exporter closes the outline.
template <class Corner, class Of = std::identity>
void drop_repeated_corners(std::vector<Corner>& polygon, const Of& position = {}) {
  if (polygon.size() <= 3) return;
  const auto at = [&](const Corner& corner) { return std::invoke(position, corner); };
  const auto same = [&](const Corner& a, const Corner& b) { return at(a) == at(b); };
  polygon.erase(std::unique(polygon.begin(), polygon.end(), same), polygon.end());
  while (polygon.size() > 1 && same(polygon.front(), polygon.back())) polygon.pop_back();
}

/// Divides polygons into triangles. Keeps its memory from one to the next.
class Triangulator {
 public:
  /// Adds n - 2 triangles, as numbers of corners, for a polygon of n >= 3 corners. They have the polygon's orientation, do not
  /// overlap, and add up to its area, if the polygon lies in a plane and does not cross itself; touching itself is allowed, as a hole
  /// that a slit joins to the outline does. Every corner is in a triangle with an area, if that is possible. Where corner 0 sees
  /// all others, the triangles are those of the fan around it; else those of the fan around the first corner that does; else ears are cut.
  ///
  /// A polygon in no plane is divided as its projection along its mean normal. One without area, or that crosses itself, is
  /// divided somehow, and counts as degenerate. So does a triangle without area.
  void divide(std::span<const glm::dvec3> corners, StopCheck& check, std::vector<std::array<std::uint32_t, 3>>& to);

  /// The triangles of a polygon whose corners are these positions, as their numbers; valid until the next call.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 3>> triangles_of(std::span<const std::uint32_t> polygon,
                                                                           std::span<const glm::dvec3> positions,
                                                                           StopCheck& check);

  /// Of all polygons so far.
  [[nodiscard]] const PolygonCounts& counts() const { return counts_; }

 private:
  /// Which corners may be cut off.
  enum class Ears {
    clean,     ///< with an area, nothing inside or on the cut, and with some area left
    spikes,    ///< without area, where the outline turns back
    touching,  ///< with an area and nothing inside
    flat,      ///< without area
    any
  };

  [[nodiscard]] bool project(std::span<const glm::dvec3> corners);
  [[nodiscard]] double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  [[nodiscard]] bool is_fan(std::uint32_t around) const;
  void cut_ears(StopCheck& check, std::vector<std::array<std::uint32_t, 3>>& to);
  [[nodiscard]] bool may_cut(std::uint32_t corner, Ears ears) const;
  [[nodiscard]] bool blocks(std::uint32_t other, const std::array<std::uint32_t, 3>& ear, bool on_cut) const;
  [[nodiscard]] bool enters(std::uint32_t other, std::uint32_t at, std::uint32_t from, std::uint32_t to) const;

  PolygonCounts counts_;
  std::vector<glm::dvec3> corners_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<glm::dvec2> flat_;  ///< corners in the plane, anticlockwise, in units of the polygon's extent
  std::vector<std::uint32_t> before_;
  std::vector<std::uint32_t> after_;
  double left_ = 0;  ///< twice the area that is not cut off yet
  std::uint32_t rest_ = 0;
};

}  // namespace detp::sim
