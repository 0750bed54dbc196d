#include "division.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

namespace detp::sim {
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
