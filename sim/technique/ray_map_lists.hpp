#pragma once

#include <cstring>
#include <numeric>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "detp/sim/lists/simd/list_search.hpp"
#include "detp/sim/lists/simd/ray_blocks.hpp"
#include "detp/sim/search/hit_collector.hpp"

/// The lists of rays of a ray map's cells, and what is done with them, by each engine.
namespace detp::sim {

/// Numbers of rays; decides in double, one ray at a time. A ray in several of a disc's cells is tested once.
class PlainRays {
 public:
  using List = std::pmr::vector<std::uint32_t>;

  PlainRays(const Problem& problem, const RunOptions& options)
      : problem_(problem),
        check_(options.stop, "searching"),
        memory_(options.memory),
        tested_for_(problem.rays().size(), 0, options.memory) {}

  [[nodiscard]] static std::size_t size(const List& list) { return list.size(); }
  [[nodiscard]] static double bytes(std::size_t rays) {
    return 2.0 * sizeof(std::uint32_t) * static_cast<double>(rays);
  }
  [[nodiscard]] static double bytes_before_splits(const Problem& problem) {
    return 3.0 * sizeof(std::uint32_t) * static_cast<double>(problem.rays().size());
  }
  [[nodiscard]] List all() const {
    List rays(problem_.rays().size(), memory_);
    std::iota(rays.begin(), rays.end(), 0U);
    return rays;
  }

  /// The rays that meet the box.
  [[nodiscard]] List inside(const List& around, const Box& box) {
    List rays(memory_);
    for_each_checked(std::span(around), check_, [&](std::uint32_t ray) {
      if (!ClippedRay(problem_.rays()[ray]).inside(box).empty()) rays.push_back(ray);
    });
    return rays;
  }

  /// Appends the rays that hit the disc. Returns the number of tests.
  std::size_t test(const List& rays, std::uint32_t disc, std::pmr::vector<std::uint32_t>& found) {
    std::size_t tests = 0;
    for_each_checked(std::span(rays), check_, [&](std::uint32_t ray) {
      if (tested_for_[ray] == disc + 1) return;
      tested_for_[ray] = disc + 1;
      ++tests;
      if (counts_as_hit(problem_, problem_.rays()[ray], problem_.discs()[disc])) found.push_back(ray);
    });
    return tests;
  }

  [[nodiscard]] static std::uint64_t doubtful() { return 0; }

 private:
  const Problem& problem_;
  StopCheck check_;
  std::pmr::memory_resource* memory_;
  List tested_for_;  ///< for each ray: 1 + the last disc against which it was tested; 0: none yet
};

/// Lists in floats that stay where they are.
class KeptLists {
 public:
  KeptLists(const stream::RayLists& from, bool segments, std::pmr::memory_resource* memory) : lines_(memory) {
    std::size_t lines = 0;
    for (const stream::RayList& list : from) lines += arrays(segments) * lines_of(list.size);
    lines_.resize(lines);
    Line* next = lines_.data();
    for (std::size_t k = 0; k < from.size(); ++k) {
      const auto copy = [&](const auto* array) {
        std::memcpy(next, array, from[k].size * sizeof(*array));
        return reinterpret_cast<std::remove_const_t<std::remove_pointer_t<decltype(array)>>*>(
            std::exchange(next, next + lines_of(from[k].size)));
      };
      lists_[k] = {from[k].size,
                   copy(from[k].a),
                   copy(from[k].b),
                   copy(from[k].p),
                   copy(from[k].q),
                   copy(from[k].id),
                   segments ? copy(from[k].from) : nullptr,
                   segments ? copy(from[k].to) : nullptr};
    }
  }

  [[nodiscard]] const stream::RayLists& lists() const { return lists_; }
  [[nodiscard]] static std::size_t arrays(bool segments) { return segments ? 7 : 5; }

 private:
  struct alignas(64) Line {
    std::array<float, 16> floats;
  };
  /// Cache lines of an array of so many floats and the padding behind it.
  [[nodiscard]] static std::size_t lines_of(std::size_t floats) { return (floats + stream::padding + 15) / 16; }

  std::pmr::vector<Line> lines_;
  stream::RayLists lists_;
};

/// Lists in floats, and vectors of rays; what floats leave in doubt is decided in double. A ray in several of a disc's cells is
/// tested in each.
class VectorRays {
 public:
  using List = KeptLists;

  /// Borrows the discs in floats, in the problem's order.
  VectorRays(const Problem& problem, const RunOptions& options, const stream::Frame& frame,
             const stream::DiscTree& discs)
      : problem_(problem),
        memory_(options.memory),
        frame_(frame),
        worker_(options.memory, options.stop),
        block_{.problem = problem,
               .frame = frame,
               .tree = discs,
               .first_ray = 0,
               .segments = problem.segments(),
               .pairs = false,
               .vectors = false,
               .hits = nullptr,
               .totals = nullptr} {}

  [[nodiscard]] static std::size_t size(const List& list) { return stream::size(list.lists()); }
  [[nodiscard]] double bytes(std::size_t rays) const {
    return static_cast<double>(sizeof(float) * KeptLists::arrays(problem_.segments())) * static_cast<double>(rays);
  }

  /// Rays as they are loaded and kept, and places of those found.
  [[nodiscard]] static double bytes_before_splits(const Problem& problem) {
    const auto rays = static_cast<double>(problem.rays().size());
    const double loaded = 3 * static_cast<double>(sizeof(float) * KeptLists::arrays(true)) * rays;
    const double kept = static_cast<double>(sizeof(float) * KeptLists::arrays(problem.segments())) * rays;
    return loaded + kept + 2.0 * sizeof(std::uint32_t) * rays;
  }
  [[nodiscard]] List all() {
    const stream::ArenaScope scope(worker_.lists);
    stream::RayLists lists;
    for (stream::RayList& list : lists) list = worker_.lists.allocate(problem_.rays().size(), true);
    stream::load_rays(problem_.rays(), frame_, lists);
    return kept(lists);
  }

  /// The rays that meet the box, and some more.
  [[nodiscard]] List inside(const List& around, const Box& box) {
    worker_.check.after(stream::test_work(size(around)));
    const stream::ArenaScope scope(worker_.lists);
    return kept(stream::cull_node(block_, in_floats(box), around.lists(), worker_));
  }

  std::size_t test(const List& rays, std::uint32_t disc, std::pmr::vector<std::uint32_t>& found) {
    worker_.check.after(stream::test_work(size(rays)));
    const auto hits = stream::find_rays(block_, disc, rays.lists(), worker_);
    found.insert(found.end(), hits.begin(), hits.end());
    return size(rays);
  }

  [[nodiscard]] std::uint64_t doubtful() const { return worker_.counts.doubtful; }

 private:
  [[nodiscard]] List kept(const stream::RayLists& lists) const { return {lists, problem_.segments(), memory_}; }

  /// The part of the box within one radius of S₀ along each axis: no disc is outside. Rounding moves its faces by less than the margin that
  /// the kernels add (sim/lists/simd/floats.md).
  [[nodiscard]] stream::TreeNode in_floats(const Box& box) const {
    stream::TreeNode node{};
    const glm::dvec3 low = glm::max(frame_(box.low), glm::dvec3(-1));
    const glm::dvec3 high = glm::min(frame_(box.high), glm::dvec3(1));
    for (int axis = 0; axis < 3; ++axis) {
      node.centre[axis] = static_cast<float>(0.5 * (low[axis] + high[axis]));
      node.half[axis] = static_cast<float>(0.5 * (high[axis] - low[axis]));
    }
    return node;
  }

  const Problem& problem_;
  std::pmr::memory_resource* memory_;
  const stream::Frame& frame_;
  stream::Worker worker_;
  stream::BlockSearch block_;
};

}  // namespace detp::sim
