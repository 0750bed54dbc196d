#include "clip.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace detp::sim {
namespace {

double distance_inwards(const FlatLine& line, const glm::dvec2& place) {
  return glm::dot(line.inwards, place - line.point);
}

}  // namespace

FlatLine line_through(const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 along = to - from;
  const double length = glm::length(along);
  return {from, length > 0 ? glm::dvec2{-along.y, along.x} / length : glm::dvec2{0.0}};
}

double width(const FlatPolygon& polygon) {
  if (polygon.size() < 3) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const FlatLine edge = line_through(polygon[i].place, polygon[(i + 1) % polygon.size()].place);
    if (edge.inwards == glm::dvec2{0.0}) continue;
    double largest = 0;
    for (const FlatCorner& corner : polygon) largest = std::max(largest, distance_inwards(edge, corner.place));
    least = std::min(least, largest);
  }
  return least;
}

bool may_overlap(std::span<const FlatCorner> polygon, const FlatTriangle& triangle, double slack) {
  for (std::size_t i = 0; i < 3; ++i) {
    const FlatLine edge = line_through(triangle[i], triangle[(i + 1) % 3]);
    const auto is_outside = [&](const FlatCorner& one) { return distance_inwards(edge, one.place) <= slack; };
    if (std::ranges::all_of(polygon, is_outside)) return false;
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const FlatLine edge = line_through(polygon[i].place, polygon[(i + 1) % polygon.size()].place);
    if (edge.inwards == glm::dvec2{0.0}) continue;
    const auto is_outside = [&](const glm::dvec2& one) { return distance_inwards(edge, one) <= slack; };
    if (std::ranges::all_of(triangle, is_outside)) return false;
  }
  return true;
}

FlatSides sides_of(const FlatPolygon& polygon, const FlatLine& line, double slack) {
  const auto distance = [&](std::size_t i) {
    const double exact = distance_inwards(line, polygon[i].place);
    return exact > slack || exact < -slack ? exact : 0.0;
  };
  FlatSides sides;
  bool some_inside = false;
  bool some_outside = false;
  double here = distance(0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    const double there = distance(next);
    if (here >= 0) sides.inside.push_back(polygon[i]);
    if (here <= 0) sides.outside.push_back(polygon[i]);
    some_inside = some_inside || here > 0;
    some_outside = some_outside || here < 0;
    if ((here > 0 && there < 0) || (here < 0 && there > 0)) {
      const double share = here / (here - there);
      const FlatCorner crossing{polygon[i].place + share * (polygon[next].place - polygon[i].place)};
      sides.inside.push_back(crossing);
      sides.outside.push_back(crossing);
    }
    here = there;
  }
  if (!some_inside) sides.inside.clear();
  if (!some_outside) sides.outside.clear();
  return sides;
}

FlatCut cut(const FlatPolygon& polygon, const FlatTriangle& triangle, double slack) {
  FlatCut result{.inside = polygon};
  for (std::size_t i = 0; i < 3; ++i) {
    FlatSides sides = sides_of(result.inside, line_through(triangle[i], triangle[(i + 1) % 3]), slack);
    if (width(sides.outside) > slack) result.outside.push_back(std::move(sides.outside));
    result.inside = std::move(sides.inside);
    if (result.inside.empty()) break;
  }
  if (!(width(result.inside) > slack)) return {.outside = {polygon}};
  return result;
}

FlatPolygon without_flat_corners(FlatPolygon polygon, double slack) {
  for (std::size_t i = 0; i < polygon.size() && polygon.size() > 3;) {
    const std::size_t count = polygon.size();
    const FlatLine chord = line_through(polygon[(i + count - 1) % count].place, polygon[(i + 1) % count].place);
    if (distance_inwards(chord, polygon[i].place) >= -slack)
      polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
  return polygon;
}

}  // namespace detp::sim
