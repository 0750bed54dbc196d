#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "detp/sim/lists/simd/list_search.hpp"
#include "detp/sim/lists/simd/load_rays.hpp"

/// Calls the float kernels directly, so that tests may narrow their bands and margins.
namespace detp::support {

/// A problem's rays and discs in the form that the kernels use.
struct Floats {
  explicit Floats(const sim::Problem& of) : problem(of), frame(of) {
    std::vector<std::uint32_t> order(problem.discs().size());
    std::iota(order.begin(), order.end(), 0U);
    discs = sim::stream::discs_in_order(problem, frame, std::move(order));
    for (sim::stream::RayList& list : lists) list = arena.allocate(problem.rays().size(), true);
    traits = load_rays(problem.rays(), frame, lists);
  }

  const sim::Problem& problem;
  sim::stream::Frame frame;
  sim::stream::DiscTree discs;  ///< the discs only; no tree
  sim::stream::ListArena arena;
  sim::stream::RayLists lists;
  sim::stream::RayTraits traits;
};

/// Hits of each disc, found by `search(block, worker)`.
template <class Search>
std::vector<std::uint64_t> count_hits(const Floats& floats, const sim::stream::Frame& frame,
                                      const sim::stream::DiscTree& discs, const Search& search) {
  std::vector<sim::stream::ClassCounts> hits(discs.discs.size());
  const sim::stream::BlockSearch block{.problem = floats.problem,
                                       .frame = frame,
                                       .tree = discs,
                                       .first_ray = 0,
                                       .segments = floats.traits.segments,
                                       .pairs = false,
                                       .vectors = false,
                                       .hits = hits.data(),
                                       .totals = nullptr};
  sim::stream::Worker worker;
  search(block, worker);
  std::vector<std::uint64_t> sums(hits.size());
  for (std::size_t place = 0; place < hits.size(); ++place)
    for (const std::uint32_t of_class : hits[place]) sums[discs.order[place]] += of_class;
  return sums;
}

/// Tests every ray against every disc, with bands `times` as wide.
inline std::vector<std::uint64_t> hits_with_band(const Floats& floats, float times) {
  sim::stream::DiscTree discs = floats.discs;
  for (sim::stream::FloatDisc& disc : discs.discs) disc.band *= times;
  return count_hits(floats, floats.frame, discs, [&](const auto& block, auto& worker) {
    for (int k = 0; k < sim::stream::classes; ++k)
      test_discs(block, k, 0, static_cast<std::uint32_t>(discs.discs.size()), floats.lists[static_cast<std::size_t>(k)],
                 worker);
  });
}

/// Searches a binary tree of boxes with one disc a leaf, with margins `times` as wide.
inline std::vector<std::uint64_t> hits_in_boxes(const Floats& floats, float times) {
  sim::stream::Frame frame = floats.frame;
  frame.margin *= times;
  const sim::stream::DiscTree tree = make_disc_tree(floats.problem, frame, {2, 1});
  return count_hits(floats, frame, tree, [&](const auto& block, auto& worker) {
    search_below(block, tree.nodes.front(), floats.lists, worker);
  });
}

/// Tests each disc with the rays that meet the sphere around it, with margins `times` as wide.
inline std::vector<std::uint64_t> hits_in_spheres(const Floats& floats, float times) {
  return count_hits(floats, floats.frame, floats.discs, [&](const auto& block, auto& worker) {
    for (std::uint32_t place = 0; place < floats.discs.discs.size(); ++place) {
      const sim::Disc& disc = floats.problem.discs()[place];
      sim::stream::FloatSphere sphere = floats.frame(sim::Sphere{disc.centre, disc.radius});
      sphere.radius += (times - 1) * floats.frame.margin;
      for (int k = 0; k < sim::stream::classes; ++k) {
        const sim::stream::RayList& around = floats.lists[static_cast<std::size_t>(k)];
        const sim::stream::ArenaScope scope(worker.lists);
        sim::stream::RayList inside = worker.lists.allocate(around.size, true);
        cull_sphere(block, k, sphere, around, inside, worker);
        test_discs(block, k, place, 1, inside, worker);
      }
    }
  });
}

}  // namespace detp::support
