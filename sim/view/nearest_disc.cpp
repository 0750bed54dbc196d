#include "nearest_disc.hpp"

#include <array>
#include <cmath>
#include <nanoflann.hpp>

#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
struct NearestDisc::Tree {
  /// Centres in the form that nanoflann requires. Building a tree asks for each of them, so it can be stopped.
  struct Centres {
    std::span<const Disc> discs;
    StopCheck* building;  ///< null once the tree is built

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return discs.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t disc, std::size_t axis) const {
      if (building != nullptr) building->after(1);
      return discs[disc].centre[static_cast<int>(axis)];
    }
    template <class BoundingBox>
    bool kdtree_get_bbox(BoundingBox&) const {
      return false;
    }
  };

  using KdTree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Centres>, Centres, 3, std::uint32_t>;
  Centres centres;
  KdTree tree;

  Tree(std::span<const Disc> discs, StopCheck& check) : centres{discs, &check}, tree(3, centres) {
    centres.building = nullptr;
  }
};

NearestDisc::NearestDisc(std::span<const Disc> discs, const std::stop_token& stop) {
  StopCheck check(stop, "sorting discs for a picture");
  tree_ = std::make_unique<Tree>(discs, check);
}

NearestDisc::~NearestDisc() = default;

std::optional<std::uint32_t> NearestDisc::at(const glm::dvec3& place, const glm::dvec3& normal) const {
  constexpr double cosine = 0.5;
  std::array<std::uint32_t, 16> discs{};
  std::array<double, 16> squares{};
  const std::size_t found = tree_->tree.knnSearch(&place.x, discs.size(), discs.data(), squares.data());
  for (std::size_t i = 0; i < found; ++i) {
    const Disc& disc = tree_->centres.discs[discs[i]];
    if (squares[i] <= reach * reach * disc.radius * disc.radius && std::abs(glm::dot(normal, disc.normal)) >= cosine)
      return discs[i];
  }
  return std::nullopt;
}

}  // namespace detp::sim
