#include "bsp_nodes.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "indexed_search.hpp"

namespace detp::sim {
namespace {

/// Rays traverse the tree front to back. Each node receives the interval of the ray that lies in it. Empty leaves are
/// kept.
class Bsp {
 public:
  Bsp(const Problem& problem, const BspParameters& parameters, const std::stop_token& stop)
      : slack_(problem.slack()), tree_(build_bsp(problem, parameters, stop)) {}

  [[nodiscard]] IndexSize size() const {
    return {.nodes = tree_.nodes.size(),
            .references = tree_.references.size(),
            .placements = tree_.placements,
            .bytes = tree_.nodes.size() * sizeof(BspNode) + tree_.references.size() * sizeof(std::uint32_t),
            .building_bytes = tree_.building_bytes};
  }

  [[nodiscard]] std::span<const std::uint32_t> references() const { return tree_.references; }

  void visit_nodes(const VisitNode& visit) const { visit_nodes(0, tree_.box, 0, visit); }

  template <class Search>
  void trace(const Ray& traced, std::uint32_t ray, Search& search) const {
    const ClippedRay clipped(traced);
    const RayInterval interval = clipped.inside({tree_.box.low - slack_, tree_.box.high + slack_});
    if (!interval.empty()) enter(0, interval, ray, clipped, search);
  }

 private:
  void visit_nodes(std::uint32_t number, const Box& box, int level, const VisitNode& visit) const {
    const BspNode& node = tree_.nodes[number];
    visit({box, level, node.leaf(), node.count});
    if (node.leaf()) return;
    for (const bool above : {false, true})
      visit_nodes(node.first + above, part_of(box, node.axis, node.plane, above), level + 1, visit);
  }

  /// `interval` is the part of the ray in the node's box, grown by the slack. Continues in the child that the ray
  /// enters first, then in the other child. The children are grown too, so a ray near the plane enters both.
  template <class Search>
  void enter(std::uint32_t number, const RayInterval& interval, std::uint32_t ray, const ClippedRay& clipped,
             Search& search) const {
    search.visit(&Counts<std::uint64_t>::nodes);
    const BspNode& node = tree_.nodes[number];
    if (node.leaf()) return search.test(ray, tree_.references_in(node));
    const double origin = clipped.origin[node.axis];
    const double inverse = clipped.inverse[node.axis];
    const double end_of_low = node.plane + slack_;
    const double start_of_high = node.plane - slack_;
    if (std::isinf(inverse)) {
      if (origin <= end_of_low) enter(node.first, interval, ray, clipped, search);
      if (origin >= start_of_high) enter(node.first + 1, interval, ray, clipped, search);
      return;
    }
    const bool up = inverse > 0;
    const RayInterval near{interval.from,
                           std::min(interval.to, ((up ? end_of_low : start_of_high) - origin) * inverse)};
    const RayInterval far{std::max(interval.from, ((up ? start_of_high : end_of_low) - origin) * inverse), interval.to};
    if (!near.empty()) enter(up ? node.first : node.first + 1, near, ray, clipped, search);
    if (!far.empty()) enter(up ? node.first + 1 : node.first, far, ray, clipped, search);
  }

  double slack_;
  BspNodes tree_;
};

}  // namespace

IndexSize inspect_bsp(const Problem& problem, const BspParameters& parameters, const VisitNode& visit,
                      const std::stop_token& stop) {
  check({Technique::bsp, parameters});
  const Bsp tree(problem, parameters, stop);
  tree.visit_nodes(visit);
  return tree.size();
}

std::unique_ptr<Index> prepare_bsp(const Problem& problem, const Parameters& parameters, const RunOptions& options) {
  return std::make_unique<TracedIndex<Bsp>>("the BSP tree", problem, options, false,
                                            std::get<BspParameters>(parameters));
}

}  // namespace detp::sim
