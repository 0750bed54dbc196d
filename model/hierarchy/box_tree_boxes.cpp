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

namespace {

using Flags = std::array<int, 3>;

constexpr int most_halvings = 64;  // 2⁶⁴ cells
// After this many halvings, cells at the cube's edges and corners hold few of the samples. From then on they count as
// cells on its faces.
constexpr int edge_halvings = 21;
constexpr int corner_halvings = 9;
static_assert(edge_halvings % 3 == 0 && corner_halvings % 3 == 0);

/// The number of halvings across an axis (axis 0 is halved first) after `halvings` halvings in total.
int across(int axis, int halvings) { return (halvings + 2 - axis) / 3; }

/// Sides of a cell; the smallest cells of the curve have the side 2^-bits.
std::array<double, 3> sides_of(int halvings, int bits) {
  std::array<double, 3> side;
  for (int axis = 0; axis < 3; ++axis) side[axis] = std::ldexp(1.0, -std::min(bits, across(axis, halvings)));
  return side;
}

std::vector<CellKind> volume_kinds(int bits) {
  std::vector<CellKind> kinds(most_halvings + 1);
  for (int i = 0; i <= most_halvings; ++i) {
    kinds[i] = {.cells = std::ldexp(1.0, i),
                .share = std::ldexp(1.0, -i),
                .side = sides_of(i, bits),
                .last = i >= 3 * bits,
                .halvings = i};
    if (i == most_halvings) break;
    const auto next = static_cast<std::uint16_t>(i + 1);
    kinds[i].child = {next, next};
    kinds[i].part = {0.5, 0.5};
  }
  return kinds;
}

int faces(const Flags& touched) { return touched[0] + touched[1] + touched[2]; }

/// Kinds of cells of a cube whose samples are all on its faces. A cell on one face only is halved along the face; all
/// faces have the same kinds.
class SurfaceKinds {
 public:
  explicit SurfaceKinds(int bits) : bits_(bits) {
    add(0, {2, 2, 2});
    add(1, {1, 2, 2});
    add(2, {1, 1, 2});
    for (int halvings = 3; halvings <= edge_halvings; ++halvings)
      for (const Flags& touched : {Flags{1, 1, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}})
        if (halvings <= corner_halvings || touched == edge) add(halvings, touched);
    for (int halvings = 0; halvings <= most_halvings; ++halvings) add_face(halvings);
    std::stable_sort(keys_.begin(), keys_.end(), [](const Key& a, const Key& b) { return a.place < b.place; });
    for (const Key& key : keys_) kinds_.push_back(key.kind);
    kinds_.front().cells = 1;
    for (std::size_t i = 0; i < kinds_.size(); ++i) split(i);
  }

  std::vector<CellKind> kinds() && { return std::move(kinds_); }

 private:
  /// A kind, its number of halvings of the cube, and its place in an order in which parents come before children.
  struct Key {
    int halvings;
    int place;
    CellKind kind;
  };

  static constexpr Flags edge{1, 0, 1};  ///< also represents edges along the other axes

  void add(int halvings, const Flags& touched) {
    const std::array<double, 3> side = sides_of(halvings, 64);
    double area = 0;
    for (int axis = 0; axis < 3; ++axis) area += touched[axis] * side[(axis + 1) % 3] * side[(axis + 2) % 3];
    // A cell that is split up into cells on faces comes before them.
    const bool whole = halvings < (faces(touched) == 3 ? corner_halvings : edge_halvings) || faces(touched) > 3;
    keys_.push_back({halvings, whole ? 4 * halvings : 4 * halvings - 3,
                     CellKind{.share = area / 6,
                              .side = sides_of(halvings, bits_),
                              .touched = touched,
                              .halvings = std::max(0, (2 * halvings - 2) / 3)}});
  }

  void add_face(int halvings) {
    // The kind comes after the last cell of the cube that is halved into it. That cell is halved across z if `halvings`
    // is even, else across y. The first four kinds never occur.
    const int place = std::max(1, halvings % 2 == 0 ? 6 * halvings - 2 : 6 * halvings);
    keys_.push_back({-1, place,
                     CellKind{.share = std::ldexp(1.0, -halvings) / 6,
                              .side = {side((halvings + 1) / 2), side(halvings / 2), 0},
                              .touched = {0, 0, 1},
                              .last = halvings >= 2 * bits_,
                              .halvings = halvings}});
  }

  double side(int halvings) const { return std::ldexp(1.0, -std::min(bits_, halvings)); }

  /// The index of this kind.
  std::size_t find(int halvings, const Flags& touched) const {
    int of_face = -1;
    if (faces(touched) == 1) of_face = halvings - across(touched[0] ? 0 : touched[1] ? 1 : 2, halvings);
    const auto at = std::find_if(keys_.begin(), keys_.end(), [&](const Key& key) {
      return of_face >= 0
                 ? key.halvings < 0 && key.kind.halvings == of_face
                 : key.halvings == halvings &&
                       key.kind.touched == (faces(touched) == 2 && halvings >= corner_halvings ? edge : touched);
    });
    return static_cast<std::size_t>(at - keys_.begin());
  }

  void split(std::size_t number) {
    const Flags touched = kinds_[number].touched;
    const int halvings = keys_[number].halvings;
    if (halvings < 0) {
      const std::size_t half = number_of_face(kinds_[number].halvings + 1);
      if (half < kinds_.size()) link(number, half, half);
    } else if (halvings == (faces(touched) == 3 ? corner_halvings : edge_halvings)) {
      const std::size_t flat = number_of_face(2 * halvings / 3);
      link(number, faces(touched) == 3 ? find(halvings, edge) : flat, flat);
    } else {
      const int axis = halvings % 3;
      Flags low = touched;
      Flags high = touched;
      if (touched[axis] > 0) {
        low[axis] = 1;
        high[axis] = touched[axis] - 1;
      }
      link(number, find(halvings + 1, low), find(halvings + 1, high));
    }
  }

  std::size_t number_of_face(int halvings) const {
    return static_cast<std::size_t>(
        std::find_if(keys_.begin(), keys_.end(),
                     [&](const Key& key) { return key.halvings < 0 && key.kind.halvings == halvings; }) -
        keys_.begin());
  }

  void link(std::size_t parent, std::size_t first, std::size_t second) {
    CellKind& kind = kinds_[parent];
    const double both = kinds_[first].share + kinds_[second].share;
    kind.child = {static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(second)};
    kind.part = {kinds_[first].share / both, kinds_[second].share / both};
    kinds_[first].cells += kind.cells;
    kinds_[second].cells += kind.cells;
  }

  int bits_;
  std::vector<Key> keys_;
  std::vector<CellKind> kinds_;
};

}  // namespace

const std::vector<CellKind>& cell_kinds(int dimension, double samples) {
  constexpr double fine = 8192;  // samples
  static const std::array coarse_curve{SurfaceKinds(6).kinds(), volume_kinds(6)};
  static const std::array fine_curve{SurfaceKinds(10).kinds(), volume_kinds(10)};
  return (samples < fine ? coarse_curve : fine_curve)[dimension - 2];
}

}  // namespace detp::model::box_tree
