#include "clip.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <utility>

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

namespace {

constexpr std::size_t few_covers = 12;  // are cut one after another
constexpr int most_halvings = 64;

class Divider {
 public:
  Divider(std::span<const Cover> covers, std::uint32_t rest, double slack, StopCheck& check)
      : covers_(covers), rest_(rest), slack_(slack), check_(check) {}

  Division take() && { return {std::move(pieces_), removed_ > 0}; }

  /// Divides by the covers with these numbers.
  void divide(const FlatPolygon& whole, const std::vector<std::uint32_t>& numbers, int halvings) {
    const std::size_t first = pieces_.size();
    const std::size_t removed_before = removed_;
    if (numbers.size() <= few_covers || halvings == most_halvings || !divide_halves(whole, numbers, halvings))
      divide_by_all(whole, numbers);
    const auto differs = [&](const LabelledPiece& one) { return one.label != pieces_[first].label; };
    if (removed_ > removed_before || pieces_.size() == first ||
        std::any_of(pieces_.begin() + static_cast<std::ptrdiff_t>(first), pieces_.end(), differs))
      return;
    pieces_.resize(first + 1);
    pieces_[first].polygon = whole;
  }

 private:
  [[nodiscard]] bool overlaps(const FlatPolygon& polygon, std::uint32_t number) {
    check_.after(1);
    return may_overlap(polygon, covers_[number].triangle, slack_);
  }

  /// False if halves are of no use, because most triangles would be in both.
  bool divide_halves(const FlatPolygon& whole, const std::vector<std::uint32_t>& numbers, int halvings) {
    glm::dvec2 low = whole[0].place;
    glm::dvec2 high = low;
    for (const FlatCorner& corner : whole) {
      low = glm::min(low, corner.place);
      high = glm::max(high, corner.place);
    }
    const bool upright = high.x - low.x >= high.y - low.y;
    const FlatLine line{0.5 * (low + high), upright ? glm::dvec2{1, 0} : glm::dvec2{0, 1}};
    const FlatSides sides = sides_of(whole, line, slack_);
    if (!(width(sides.inside) > slack_ && width(sides.outside) > slack_)) return false;
    std::vector<std::uint32_t> inside;
    std::vector<std::uint32_t> outside;
    for (const std::uint32_t number : numbers) {
      if (overlaps(sides.inside, number)) inside.push_back(number);
      if (overlaps(sides.outside, number)) outside.push_back(number);
    }
    constexpr double most_twice = 1.7;
    if (static_cast<double>(inside.size() + outside.size()) > most_twice * static_cast<double>(numbers.size()))
      return false;
    divide(sides.inside, inside, halvings + 1);
    divide(sides.outside, outside, halvings + 1);
    return true;
  }

  void divide_by_all(const FlatPolygon& whole, const std::vector<std::uint32_t>& numbers) {
    std::vector<FlatPolygon> open{whole};
    for (const std::uint32_t number : numbers) {
      if (open.empty()) return;
      std::vector<FlatPolygon> left;
      for (FlatPolygon& polygon : open)
        if (!overlaps(polygon, number) || !take_covered(polygon, number, left)) left.push_back(std::move(polygon));
      open = std::move(left);
    }
    for (FlatPolygon& polygon : open) pieces_.push_back({std::move(polygon), rest_});
  }

  /// Takes the covered part of the polygon and adds the others to `left`; false if there is none.
  bool take_covered(const FlatPolygon& polygon, std::uint32_t number, std::vector<FlatPolygon>& left) {
    FlatCut parts = cut(polygon, covers_[number].triangle, slack_);
    if (parts.inside.empty()) return false;
    const std::uint32_t label = covers_[number].label;
    if (label == Cover::removed)
      ++removed_;
    else
      pieces_.push_back({parts.outside.empty() ? polygon : std::move(parts.inside), label});
    for (FlatPolygon& part : parts.outside) left.push_back(std::move(part));
    return true;
  }

  std::span<const Cover> covers_;
  std::uint32_t rest_;
  double slack_;
  StopCheck& check_;
  std::vector<LabelledPiece> pieces_ = {};
  std::size_t removed_ = 0;
};

}  // namespace

Division divided(const FlatPolygon& polygon, std::span<const Cover> covers, std::uint32_t rest, double slack,
                 StopCheck& check) {
  std::vector<std::uint32_t> numbers(covers.size());
  for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
  Divider divider(covers, rest, slack, check);
  divider.divide(polygon, numbers, 0);
  return std::move(divider).take();
}

}  // namespace detp::sim
