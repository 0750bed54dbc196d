#include "wall.hpp"

#include "mesh_pieces.hpp"

namespace detp::sim::built_in {
namespace {

/// One bay of a wall, in its own coordinates: x along the wall, y up, z through it.
class Bay {
 public:
  Bay(const Wall& wall, int bays, int number, const Opening& opening)
      : wall_(wall),
        opening_(opening),
        length_(wall.length / bays),
        start_(wall.corner + number * length_ * wall.along),
        left_(0.5 * (length_ - opening.width)),
        right_(0.5 * (length_ + opening.width)) {}

  void add_to(Mesh& mesh, double cell) const {
    for (const bool front : {false, true}) {
      add_panel(mesh, front, 0, left_, cell);
      add_panel(mesh, front, right_, length_, cell);
      add_over_opening(mesh, front, cell);
      if (opening_.sill > 0) add_face(mesh, front, {left_, right_, 0, opening_.sill}, cell);
    }
    add_depth(mesh, cell);
  }

 private:
  struct Rectangle {
    double left, right, low, high;
  };

  [[nodiscard]] glm::dvec3 place(double x, double y, double z) const {
    return start_ + x * wall_.along + y * glm::dvec3{0, 1, 0} + z * wall_.out;
  }

  /// A point on the underside of the arch over the opening, which is a parabola.
  [[nodiscard]] glm::dvec3 arch(double share, double z) const {
    return place(left_ + share * opening_.width, opening_.springing + 4 * opening_.rise * share * (1 - share), z);
  }

  void add_face(Mesh& mesh, bool front, const Rectangle& r, double cell) const {
    const double z = front ? wall_.thickness : 0;
    const double first = front ? r.left : r.right;
    const double second = front ? r.right : r.left;
    add_quad(mesh, {place(first, r.low, z), place(second, r.low, z), place(second, r.high, z), place(first, r.high, z)},
             cell);
  }

  void add_panel(Mesh& mesh, bool front, double left, double right, double cell) const {
    add_face(mesh, front, {left, right, 0, wall_.height}, cell);
  }

  void add_over_opening(Mesh& mesh, bool front, double cell) const {
    const double z = front ? wall_.thickness : 0;
    const double mean_height = wall_.height - opening_.springing - 2 * opening_.rise / 3;
    add_patch(mesh, {cells_along(opening_.width, cell), cells_along(mean_height, cell)}, [&](double u, double v) {
      const double share = front ? u : 1 - u;
      const glm::dvec3 top = place(left_ + share * opening_.width, wall_.height, z);
      return (1 - v) * arch(share, z) + v * top;
    });
  }

  /// Adds the inner faces of the opening: its two sides, its top and its sill.
  void add_depth(Mesh& mesh, double cell) const {
    const double t = wall_.thickness;
    const double low = opening_.sill;
    const double high = opening_.springing;
    add_quad(mesh, {place(left_, low, t), place(left_, low, 0), place(left_, high, 0), place(left_, high, t)}, cell);
    add_quad(mesh, {place(right_, low, 0), place(right_, low, t), place(right_, high, t), place(right_, high, 0)},
             cell);
    add_patch(mesh, {cells_along(opening_.width, cell), cells_along(t, cell)},
              [&](double u, double v) { return arch(u, v * t); });
    if (low > 0)
      add_quad(mesh, {place(left_, low, t), place(right_, low, t), place(right_, low, 0), place(left_, low, 0)}, cell);
  }

  const Wall& wall_;
  const Opening& opening_;
  double length_;
  glm::dvec3 start_;
  double left_, right_;
};

}  // namespace

void add_wall(Mesh& mesh, const Wall& wall, int bays, const Opening& opening, double cell) {
  for (int number = 0; number < bays; ++number) Bay(wall, bays, number, opening).add_to(mesh, cell);
}

}  // namespace detp::sim::built_in
