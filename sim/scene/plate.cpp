#include "plate.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "facet.hpp"
#include "vertices.hpp"

namespace detp::sim {
namespace {

constexpr double most_sine = 1e-3;  // between planes that can be the same
constexpr double rounding = 1e-14;  // of the sine between two normals, and of distances

/// The plane of `other` cannot be within the slack of a part of `one` that is as wide as the smaller of them.
bool is_surely_apart(const Plate& one, const Plate& other, double slack) {
  constexpr double least_cosine = 1 - most_sine * most_sine;
  if (std::abs(glm::dot(one.normal, other.normal)) < least_cosine) return true;
  const double sine = glm::length(glm::cross(one.normal, other.normal));
  if (sine > std::min(most_sine, 4 * slack / std::min(one.height, other.height) + rounding)) return true;
  const double away = std::abs(glm::dot(one.normal, other.corners[0] - one.corners[0]));
  return away > 2 * slack + (sine + rounding) * other.longest;
}

}  // namespace

PlateView::PlateView(const Plate& plate)
    : origin_(plate.corners[0]), normal_(plate.normal), axis_(dominant_axis(plate.normal)) {
  u_ = normal_[axis_] > 0 ? (axis_ + 1) % 3 : (axis_ + 2) % 3;
  v_ = 3 - axis_ - u_;
  slope_ = -glm::dvec2{normal_[u_], normal_[v_]} / normal_[axis_];
}

FlatTriangle PlateView::flat(const Plate& other) const {
  FlatTriangle triangle{flat(other.corners[0]), flat(other.corners[1]), flat(other.corners[2])};
  if (glm::dot(normal_, other.normal) < 0) std::swap(triangle[1], triangle[2]);
  return triangle;
}

FlatPolygon PlateView::polygon(const Plate& plate) const {
  return {{flat(plate.corners[0]), 0}, {flat(plate.corners[1]), 1}, {flat(plate.corners[2]), 2}};
}

bool is_turned(const Plate& one, const Plate& other) { return glm::dot(one.normal, other.normal) < 0; }

bool coincide(const Plate& one, const Plate& other, double slack) {
  if (is_surely_apart(one, other, slack)) return false;
  const PlateView view(one);
  std::array<FlatCorner, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) corners[i].place = view.flat(one.corners[i]);
  const FlatTriangle triangle = view.flat(other);
  if (!may_overlap(corners, triangle, slack)) return false;
  const FlatCut both = cut({corners.begin(), corners.end()}, triangle, slack);
  const glm::dvec3 between = other.corners[0] - one.corners[0];
  const auto is_in_plane = [&](const FlatCorner& corner) {
    return std::abs(glm::dot(other.normal, view.offset(corner.place) - between)) <= slack;
  };
  return !both.inside.empty() && std::ranges::all_of(both.inside, is_in_plane);
}

namespace {

constexpr const char* preparing = "looking for faces with the same corners";
constexpr double slack_share = 1e-9;  // of the diagonal
constexpr double unit_slack = 4e-16;  // rounding of coordinates of about the size 1

using Corners = std::array<glm::dvec3, 3>;

struct Placement {
  double diagonal = 0;
  Scaling scaled = Scaling{};  ///< to about 1
};

/// The diagonal is scaled.
Placement placement_of(const Mesh& mesh, StopCheck& check) {
  Box box;
  for_each_checked(std::span(mesh.triangles), check, [&](const auto& triangle) {
    for (const std::uint32_t corner : triangle) box.include(mesh.positions[corner]);
  });
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) largest = std::max({largest, std::abs(box.low[axis]), std::abs(box.high[axis])});
  if (largest == 0 || !std::isfinite(largest)) return {};
  const Scaling scaled = Scaling::to_one(largest);
  return {glm::length(scaled(box.high) - scaled(box.low)), scaled};
}

/// Triangle numbers: those that emit more first.
std::vector<std::uint32_t> winners_first(const Mesh& mesh, StopCheck& check) {
  std::vector<std::uint32_t> order(mesh.triangles.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto emits = [](const Material& one) { return one.emitted > 0; };
  if (std::ranges::none_of(mesh.materials.all, emits)) return order;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    check.after(1);
    return mesh.materials.of(a).emitted > mesh.materials.of(b).emitted;
  });
  return order;
}

std::uint64_t mixed(std::uint64_t word) {
  word *= 0x9e3779b97f4a7c15ULL;
  return word ^ (word >> 32);
}

/// Finds triangles with the same positions in the same cyclic order.
class SameCorners {
  using Triangle = std::array<std::uint32_t, 3>;

 public:
  SameCorners(const Mesh& mesh, StopCheck& check)
      : mesh_(mesh),
        places_(first_of_place(mesh.positions, check)),
        table_(std::bit_ceil(2 * mesh.triangles.size() + 1)) {}

  /// Whether no triangle before has these corners.
  bool is_first(std::uint32_t triangle) {
    const Triangle corners = turned_to_least(triangle);
    std::uint64_t hash = 0;
    for (const std::uint32_t corner : corners) hash = mixed(hash ^ corner);
    const auto mark = static_cast<std::uint32_t>(hash >> 32);
    std::size_t slot = hash & (table_.size() - 1);
    for (; table_[slot].triangle != none; slot = (slot + 1) & (table_.size() - 1))
      if (table_[slot].mark == mark && turned_to_least(table_[slot].triangle) == corners) return false;
    table_[slot] = {triangle, mark};
    return true;
  }

 private:
  static constexpr std::uint32_t none = UINT32_MAX;
  struct Entry {
    std::uint32_t triangle = none;
    std::uint32_t mark = 0;  ///< of the hash
  };

  /// Places of the corners, the least first.
  [[nodiscard]] Triangle turned_to_least(std::uint32_t triangle) const {
    const auto& corners = mesh_.triangles[triangle];
    const Triangle at{places_[corners[0]], places_[corners[1]], places_[corners[2]]};
    const auto& [a, b, c] = at;
    if (b < a && b <= c) return {b, c, a};
    return c < a ? Triangle{c, a, b} : at;
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> places_;
  std::vector<Entry> table_;
};

/// Without a normal if it has no area.
Plate plate_of(const Corners& corners, std::uint32_t triangle) {
  const Facet facet = make_facet(corners[0], corners[1], corners[2]);
  const glm::dvec3 third = facet.second - facet.first;
  const double longest = std::sqrt(
      std::max({glm::dot(facet.first, facet.first), glm::dot(facet.second, facet.second), glm::dot(third, third)}));
  const double doubled_area = glm::length(glm::cross(facet.first, facet.second));
  return {corners, facet.normal, longest > 0 ? doubled_area / longest : 0, longest, triangle};
}

/// In this order, whether a triangle has the corners of one before.
std::vector<bool> repeated_ones(const Mesh& mesh, std::span<const std::uint32_t> order, const std::stop_token& stop) {
  StopCheck check(stop, preparing);
  SameCorners same(mesh, check);
  std::vector<bool> repeated;
  repeated.reserve(order.size());
  for_each_checked(order, check, [&](std::uint32_t triangle) { repeated.push_back(!same.is_first(triangle)); });
  return repeated;
}

std::vector<Plate> all_plates(const Mesh& mesh, std::span<const std::uint32_t> order, const Scaling& scaled,
                              const std::stop_token& stop) {
  StopCheck check(stop, preparing);
  std::vector<Plate> plates;
  plates.reserve(order.size());
  const auto at = [&](std::uint32_t corner) { return scaled(mesh.positions[corner]); };
  for_each_checked(order, check, [&](std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    plates.push_back(plate_of({at(a), at(b), at(c)}, triangle));
  });
  return plates;
}

}  // namespace

Plates plates_of(const Mesh& mesh, const std::stop_token& stop) {
  StopCheck check(stop, preparing);
  const Placement placement = placement_of(mesh, check);
  if (!(placement.diagonal > 0)) return {};
  Plates plates{.slack = std::max(slack_share * placement.diagonal, unit_slack), .scaled = placement.scaled};
  const std::vector<std::uint32_t> order = winners_first(mesh, check);
  std::vector<bool> repeated;
  sim::parallel_invoke([&] { repeated = repeated_ones(mesh, order, stop); },
                       [&] { plates.all = all_plates(mesh, order, placement.scaled, stop); });
  std::size_t kept = 0;
  for_each_checked(0, order.size(), check, [&](std::size_t i) {
    const Plate& plate = plates.all[i];
    if (plate.normal == glm::dvec3{0.0}) return;
    if (repeated[i]) {
      plates.repeated.push_back(plate.triangle);
      plates.emitting_repeated += mesh.materials.of(plate.triangle).emitted > 0 ? 1 : 0;
    } else if (plate.height > plates.slack) {
      if (kept < i) plates.all[kept] = plate;
      ++kept;
    }
  });
  plates.all.resize(kept);
  return plates;
}

}  // namespace detp::sim
