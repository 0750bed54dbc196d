#include "box_tree_boxes.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace detp::model::box_tree {

CellBoxes::CellBoxes(const CellKind& cell, const BoxEnds& ends, const Listing& listing)
    : radius_(ends.largest_radius()), extent_variance_(ends.extent_variance()), listing_(listing), flat_(ends.row(0)) {
  std::array<double, 3> on_faces{};
  double area = 0;
  for (int axis = 0; axis < 3; ++axis)
    area += on_faces[axis] = cell.touched[axis] * cell.side[(axis + 1) % 3] * cell.side[(axis + 2) % 3];
  for (int axis = 0; axis < 3; ++axis) {
    Axis& along = axes_[axis];
    along.length = cell.side[axis];
    along.uniform = ends.row(along.length);
    along.touched = cell.touched[axis];
    if (along.touched == 0) continue;
    const double on_either = on_faces[axis] / area;
    along.on_face = on_either / along.touched;
    along.uniform_share = 1 - on_either;
    if (along.uniform_share <= 0) continue;
    along.log_off_face = std::log1p(-along.on_face);
    along.log_on_faces = std::log(on_either);
  }
}

double CellBoxes::side_of(const Axis& axis, double discs) const {
  const double whole = axis.length + 2 * radius_;
  if (axis.touched == 0) return whole - 2 * axis.uniform.missing(discs);
  if (axis.uniform_share <= 0) return axis.touched == 1 ? 2 * (radius_ - flat_.missing(discs)) : whole;
  // Discs on a face determine the box's end there. The uniform discs determine it if no disc is on that face.
  const double none_on = std::exp(discs * axis.log_off_face);
  const double uniform = axis.uniform.missing(axis.uniform_share * discs);
  const double at_face = (1 - none_on) * flat_.missing(axis.on_face * discs) + none_on * uniform;
  if (axis.touched == 2) return std::max(0.0, whole - 2 * at_face);
  const double all_on = std::exp(discs * axis.log_on_faces);
  const double at_end = (1 - all_on) * uniform + all_on * (axis.length + flat_.missing(discs));
  return std::max(0.0, whole - at_face - at_end);
}

void CellBoxes::products(std::span<double> products) const {
  assert(products.size() <= BoxEnds::most_exact);
  std::array<std::array<double, BoxEnds::most_exact>, 3> side;
  for (std::size_t i = 0; i < 3; ++i) {
    const Axis& axis = axes_[i];
    assert(axis.touched == 0 || (axis.touched == 1 && axis.uniform_share <= 0));
    const double whole = axis.touched == 0 ? axis.length + 2 * radius_ : 2 * radius_;
    const Row row = axis.touched == 0 ? axis.uniform : flat_;
    row.missing_up_to(std::span(side[i]).first(products.size()));
    for (std::size_t m = 0; m < products.size(); ++m) side[i][m] = whole - 2 * side[i][m];
  }
  for (std::size_t m = 0; m < products.size(); ++m) {
    products[m] = side[0][m] * side[1][m];
    products[m] += side[1][m] * side[2][m];
    products[m] += side[2][m] * side[0][m];
  }
}

double CellBoxes::variance_of(const Axis& axis, double discs) const {
  const double uniform = axis.uniform_share * discs;
  const double length = uniform > 1 ? axis.length / (uniform + 1) : 0;
  return 2 * length * length * (uniform - 1) / (uniform + 2) + extent_variance_ / discs;
}

MeanBox CellBoxes::operator()(double discs) const {
  std::array<double, 3> side{};
  std::array<double, 3> variance{};
  for (int i = 0; i < 3; ++i) {
    side[i] = side_of(axes_[i], discs);
    variance[i] = variance_of(axes_[i], discs);
  }
  MeanBox box;
  double squares = 0;
  box.volume = 1;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    box.products += side[i] * side[j];
    box.spread += variance[i] * (std::pow(side[j] + side[k], 2) + variance[j]);
  }
  box.spread /= box.products * box.products;
  double grown = 0;
  for (double& one : side) one += 2 * listing_.margin;
  for (int i = 0; i < 3; ++i) {
    grown += side[i] * side[(i + 1) % 3];
    squares += side[i] * side[i];
    box.volume *= side[i];
  }
  box.surface = 2 * (grown + (listing_.engine == Engine::simd ? listed_beyond * squares : 0));
  return box;
}

}  // namespace detp::model::box_tree
