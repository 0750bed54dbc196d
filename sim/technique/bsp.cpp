#include "bsp_nodes.hpp"
#include "indexed_search.hpp"
#include "ray_box.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

class Bsp {
 public:
  Bsp(const Problem& problem, const BspParameters& parameters, const std::stop_token& stop)
      : problem_(problem), tree_(build_bsp(problem, parameters, stop)) {}

  [[nodiscard]] IndexSize size() const {
    return {.nodes = tree_.nodes.size(),
            .references = tree_.references.size(),
            .placements = tree_.placements,
            .bytes = tree_.nodes.size() * sizeof(BspNode) + tree_.references.size() * sizeof(std::uint32_t),
            .building_bytes = tree_.building_bytes};
  }

  void show(const VisitNode& visit) const { show(0, tree_.box, 0, visit); }

  template <class Search>
  void trace(std::uint32_t ray, Search& search) const {
    const ClippedRay clipped(problem_.rays[ray]);
    const Stretch stretch = clipped.inside({tree_.box.low - problem_.slack, tree_.box.high + problem_.slack});
    if (!stretch.empty()) enter(0, stretch, ray, clipped, search);
  }

 private:
  void show(std::uint32_t number, const Box& box, int level, const VisitNode& visit) const {
    const BspNode& node = tree_.nodes[number];
    visit({box, level, node.leaf(), node.count});
    if (node.leaf()) return;
    for (const bool above : {false, true})
      show(node.first + above, part_of(box, node.axis, node.plane, above), level + 1, visit);
  }

  /// The ray is in the node, grown by the slack, for that stretch: it goes on into the part that it enters first, and
  /// then into the other. The parts are grown too, so that near the plane it is in both.
  template <class Search>
  void enter(std::uint32_t number, const Stretch& stretch, std::uint32_t ray, const ClippedRay& clipped,
             Search& search) const {
    search.visit(&Counts<std::uint64_t>::nodes);
    const BspNode& node = tree_.nodes[number];
    if (node.leaf()) return search.test(ray, tree_.references_in(node));
    const double origin = clipped.origin[node.axis];
    const double inverse = clipped.inverse[node.axis];
    const double end_of_low = node.plane + problem_.slack;
    const double start_of_high = node.plane - problem_.slack;
    if (std::isinf(inverse)) {
      if (origin <= end_of_low) enter(node.first, stretch, ray, clipped, search);
      if (origin >= start_of_high) enter(node.first + 1, stretch, ray, clipped, search);
      return;
    }
    const bool up = inverse > 0;
    const Stretch near{stretch.from, std::min(stretch.to, ((up ? end_of_low : start_of_high) - origin) * inverse)};
    const Stretch far{std::max(stretch.from, ((up ? start_of_high : end_of_low) - origin) * inverse), stretch.to};
    if (!near.empty()) enter(up ? node.first : node.first + 1, near, ray, clipped, search);
    if (!far.empty()) enter(up ? node.first + 1 : node.first, far, ray, clipped, search);
  }

  const Problem& problem_;
  BspNodes tree_;
};

}  // namespace

IndexSize inspect_bsp(const Problem& problem, const BspParameters& parameters, const VisitNode& visit,
                      const std::stop_token& stop) {
  check({Technique::bsp, parameters});
  const Bsp tree(problem, parameters, stop);
  tree.show(visit);
  return tree.size();
}

std::unique_ptr<Prepared> prepare_bsp(const Problem& problem, const BspParameters& parameters,
                                      const std::stop_token& stop) {
  return std::make_unique<PreparedIndex<Bsp>>(problem, false, parameters, stop);
}

void run_bsp(const Problem& problem, const BspParameters& parameters, const RunOptions& options, Outcome& outcome) {
  Stopwatch watch;
  const Bsp tree(problem, parameters, options.stop);
  outcome.seconds.build = watch.lap();
  need_index_memory("the BSP tree", tree.size(), problem, options, outcome);
  search_index(tree, problem, false, options, outcome);
  outcome.seconds.search = watch.lap();
}

}  // namespace detp::sim
