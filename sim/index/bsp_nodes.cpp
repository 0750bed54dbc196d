#include "bsp_nodes.hpp"

#include <array>
#include <numeric>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "indexed_search.hpp"

namespace detp::sim {
namespace {

/// Two sides, or two costs, count as equal if the smaller one is at least this share of the larger one. Then rounding
/// and the slack do not affect the tree: the same discs always give the same tree.
constexpr double clear = 1 - 1e-9;

using Discs = std::vector<std::uint32_t>;

/// A plane across an axis.
struct Split {
  int axis;
  double plane;
};

Split halving(const Box& box) {
  const glm::dvec3 size = box.size();
  const int longer = clear * size.y <= size.x ? 0 : 1;
  const int axis = clear * size.z <= size[longer] ? longer : 2;
  return {axis, box.centre()[axis]};
}

double area_of(const glm::dvec3& size) { return 2 * (size.x * size.y + size.y * size.z + size.z * size.x); }

class Builder {
 public:
  Builder(const Problem& problem, const BspParameters& parameters, const std::stop_token& stop)
      : problem_(problem), parameters_(parameters), check_(stop, "building the BSP tree") {
    check_.now();
    tree_.box = index_box(problem);
  }

  BspNodes build() && {
    require_memory("the bounds of the discs", static_cast<double>(problem_.discs().size()) * sizeof(Box));
    bounds_.reserve(problem_.discs().size());
    for_each_checked(problem_.discs(), check_,
                     [&](const Disc& disc) { bounds_.push_back(bounds(disc, problem_.slack())); });
    Discs all(problem_.discs().size());
    std::iota(all.begin(), all.end(), 0U);
    listed_ = most_listed_ = all.size();
    tree_.nodes.emplace_back();
    build(0, tree_.box, 0, std::move(all));
    tree_.building_bytes = needed(0);
    tree_.nodes.shrink_to_fit();
    tree_.references.shrink_to_fit();
    return std::move(tree_);
  }

 private:
  void build(std::uint32_t number, const Box& box, int level, Discs discs) {
    check_.after(1);
    require_room(discs.size());
    const Split split = halving(box);
    if (level == parameters_.depth || discs.size() <= static_cast<std::size_t>(parameters_.leaf) ||
        !is_worthwhile(split, box, discs))
      return make_leaf(number, discs);
    const std::array<Box, 2> boxes{part_of(box, split.axis, split.plane, false),
                                   part_of(box, split.axis, split.plane, true)};
    std::array<Discs, 2> parts{discs_in(boxes[0], discs), discs_in(boxes[1], discs)};
    listed_ += parts[0].size() + parts[1].size();
    most_listed_ = std::max(most_listed_, listed_);
    listed_ -= discs.size();
    tree_.placements += parts[0].size() + parts[1].size();
    discs = {};
    const auto first = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes[number] = {.plane = split.plane, .first = first, .axis = split.axis};
    tree_.nodes.resize(first + 2);
    for (unsigned part = 0; part < 2; ++part) build(first + part, boxes[part], level + 1, std::move(parts[part]));
  }

  /// Whether searching the halves is expected to be cheaper than testing all discs.
  [[nodiscard]] bool is_worthwhile(const Split& split, const Box& box, const Discs& discs) {
    double in_parts = 0;
    for_each_checked(std::span(discs), check_, [&](std::uint32_t disc) {
      in_parts += bounds_[disc].low[split.axis] <= split.plane ? 1 : 0;
      in_parts += bounds_[disc].high[split.axis] >= split.plane ? 1 : 0;
    });
    const double half = area_of(part_of(box, split.axis, split.plane, false).size());
    const double visit = parameters_.leaf / 4.0;
    return half * (2 * visit + in_parts) < clear * area_of(box.size()) * static_cast<double>(discs.size());
  }

  void make_leaf(std::uint32_t number, const Discs& discs) {
    tree_.nodes[number].first = static_cast<std::uint32_t>(tree_.references.size());
    tree_.nodes[number].count = static_cast<std::uint32_t>(discs.size());
    tree_.references.insert(tree_.references.end(), discs.begin(), discs.end());
    listed_ -= discs.size();
  }

  Discs discs_in(const Box& box, const Discs& discs) {
    Discs inside;
    for_each_checked(std::span(discs), check_, [&](std::uint32_t disc) {
      if (overlaps(problem_.discs()[disc], box, problem_.slack())) inside.push_back(disc);
    });
    return inside;
  }

  /// Predicted bytes with `more` additional references. Includes the copy that trims the arrays at the end.
  [[nodiscard]] double needed(std::size_t more) const {
    const std::size_t references = tree_.references.size() + more;
    return static_cast<double>(bounds_.size()) * sizeof(Box) +
           static_cast<double>(most_listed_) * sizeof(std::uint32_t) +
           std::max(grown_bytes(references, sizeof(std::uint32_t)),
                    2.0 * static_cast<double>(references) * sizeof(std::uint32_t)) +
           grown_bytes(tree_.nodes.size() + 2, sizeof(BspNode));
  }

  /// Throws std::length_error if there is no room to split a node with `discs` discs, or to store its references.
  void require_room(std::size_t discs) const {
    require_memory("the BSP tree", needed(discs) + 2 * static_cast<double>(discs) * sizeof(std::uint32_t));
    if (tree_.references.size() + discs >= UINT32_MAX || tree_.nodes.size() + 2 >= UINT32_MAX)
      throw std::length_error("the BSP tree would hold 2^32 or more references; a smaller depth is needed");
  }

  const Problem& problem_;
  const BspParameters& parameters_;
  StopCheck check_;
  std::vector<Box> bounds_;
  std::size_t listed_ = 0;       ///< discs in the lists of unfinished nodes
  std::size_t most_listed_ = 0;  ///< the largest value of listed_
  BspNodes tree_;
};

}  // namespace

Box part_of(Box box, int axis, double plane, bool above) {
  (above ? box.low : box.high)[axis] = plane;
  return box;
}

BspNodes build_bsp(const Problem& problem, const BspParameters& parameters, const std::stop_token& stop) {
  return Builder(problem, parameters, stop).build();
}

}  // namespace detp::sim
