#include <algorithm>
#include <numeric>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "detp/sim/index/indexed_search.hpp"
#include "detp/sim/search/hit_collector.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "registry.hpp"

namespace detp::sim {
namespace {

/// Numbers of rays.
using Rays = std::pmr::vector<std::uint32_t>;

/// A cell with the rays that cross it, or two halves.
struct Cell {
  Box box;
  Rays rays;                ///< empty once the cell is split
  std::uint32_t first = 0;  ///< number of the lower half, which the upper half follows; 0: not split
  bool final = false;       ///< splitting it does not separate its rays

  [[nodiscard]] bool is_split() const { return first != 0; }
};

/// A kd-tree over rays. When a disc searches a cell, the cell is halved across its longest side if it has more rays
/// than `leaf` and is longer than the largest disc is wide. (In a smaller cell, a disc would search most of the parts.)
/// A cell is not halved if most of its rays would be in both halves, for instance if the rays coincide.
///
/// Source  V. Havran, J. Bittner, H.-P. Seidel: Ray Maps for Global Illumination (2004); the splitting rule is ours.
template <bool counting>
class RayMap {
 public:
  RayMap(const Problem& problem, const RunOptions& options, int leaf)
      : problem_(problem),
        leaf_(static_cast<std::size_t>(leaf)),
        check_(options.stop, "searching"),
        cells_(options.memory),
        tested_for_(problem.rays().size(), 0, options.memory),
        found_(options.memory) {
    narrowest_ = 8 * problem.slack();  // includes the growth of both halves
    for (const Disc& disc : problem.discs()) narrowest_ = std::max(narrowest_, 2 * disc.radius);
    Rays all(problem.rays().size(), options.memory);
    std::iota(all.begin(), all.end(), 0U);
    cells_.push_back({index_box(problem), std::move(all)});
  }

  /// The rays that hit the disc, in rising order of their numbers.
  const Rays& find(std::uint32_t disc) {
    found_.clear();
    search_node(0, disc, bounds(problem_.discs()[disc], 2 * problem_.slack()));
    std::sort(found_.begin(), found_.end());
    return found_;
  }

  [[nodiscard]] const Counts<std::uint64_t>& counts() const { return tally_.counts(); }

 private:
  void search_node(std::uint32_t number, std::uint32_t disc, const Box& reach) {
    tally_.add(&Counts<std::uint64_t>::nodes);
    check_.after(1);
    if (!cells_[number].is_split() && should_split(cells_[number])) split(number);
    if (!cells_[number].is_split()) return test(cells_[number].rays, disc);
    for (const std::uint32_t half : {cells_[number].first, cells_[number].first + 1})
      if (overlap(cells_[half].box, reach)) search_node(half, disc, reach);
  }

  [[nodiscard]] static bool overlap(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
  }

  [[nodiscard]] bool should_split(const Cell& cell) const {
    const glm::dvec3 size = cell.box.size();
    return !cell.final && cell.rays.size() > leaf_ && std::max({size.x, size.y, size.z}) > narrowest_;
  }

  /// One half of a cell, with the rays that meet the half grown by the slack. Rays near the middle are in both halves.
  [[nodiscard]] Cell half_of(const Cell& cell, int axis, bool upper) {
    Cell half{cell.box, Rays(cell.rays.get_allocator())};
    (upper ? half.box.low : half.box.high)[axis] = cell.box.centre()[axis];
    const Box grown{half.box.low - problem_.slack(), half.box.high + problem_.slack()};
    for_each_checked(std::span(cell.rays), check_, [&](std::uint32_t ray) {
      if (!ClippedRay(problem_.rays()[ray]).inside(grown).empty()) half.rays.push_back(ray);
    });
    tally_.add(&Counts<std::uint64_t>::culls);
    tally_.add(&Counts<std::uint64_t>::cull_tests, cell.rays.size());
    tally_.add(&Counts<std::uint64_t>::listed, half.rays.size());
    return half;
  }

  void split(std::uint32_t number) {
    const glm::dvec3 size = cells_[number].box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    Cell lower = half_of(cells_[number], axis, false);
    Cell upper = half_of(cells_[number], axis, true);
    constexpr double most_twice = 1.9;  // entries in the halves' lists, per ray; a line meets 4/3 halves of a cube
    const auto in_halves = static_cast<double>(lower.rays.size() + upper.rays.size());
    cells_[number].final = in_halves > most_twice * static_cast<double>(cells_[number].rays.size());
    if (cells_[number].final) return;
    listed_ += lower.rays.size() + upper.rays.size();
    listed_ -= std::min(listed_, cells_[number].rays.size());
    Rays(cells_.get_allocator()).swap(cells_[number].rays);
    cells_[number].first = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back(std::move(lower));
    cells_.push_back(std::move(upper));
    require_memory_for("the ray map",
                       grown_bytes(cells_.size(), sizeof(Cell)) +
                           2 * sizeof(std::uint32_t) * static_cast<double>(listed_ + problem_.rays().size()),
                       problem_);
  }

  /// Tests the rays against the disc. A ray in several of the disc's cells is tested once.
  void test(const Rays& rays, std::uint32_t disc) {
    tally_.add(&Counts<std::uint64_t>::visits);
    for_each_checked(std::span(rays), check_, [&](std::uint32_t ray) {
      if (tested_for_[ray] == disc + 1) return;
      tested_for_[ray] = disc + 1;
      tally_.add(&Counts<std::uint64_t>::disc_tests);
      if (counts_as_hit(problem_, problem_.rays()[ray], problem_.discs()[disc])) found_.push_back(ray);
    });
  }

  const Problem& problem_;
  std::size_t leaf_;
  StopCheck check_;
  Tally<counting> tally_;
  double narrowest_ = 0;  ///< shorter cells are not split
  std::pmr::vector<Cell> cells_;
  std::size_t listed_ = 0;  ///< rays in cells that are not split, except the root
  Rays tested_for_;         ///< for each ray: 1 + the last disc against which it was tested; 0: none yet
  Rays found_;
};

/// Each disc looks up the rays that cross it. Builds nothing before the rays are known. The search runs on one thread.
class RayMapIndex final : public Index {
 public:
  explicit RayMapIndex(int leaf) : leaf_(leaf) {}

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    const double rays = 3.0 * sizeof(std::uint32_t) * static_cast<double>(problem.rays().size());
    add_checked_bytes("the ray map", rays + 2 * found_bytes(problem, options), problem, outcome);
    options.count ? search_discs<true>(problem, options, outcome) : search_discs<false>(problem, options, outcome);
  }

 private:
  template <bool counting>
  void search_discs(const Problem& problem, const RunOptions& options, Outcome& outcome) const {
    RayMap<counting> map(problem, options, leaf_);
    HitCollector collector(problem, options, outcome);
    collector.save_totals();
    std::uint32_t done = 0;
    try {
      for (; done < problem.discs().size(); ++done) {
        report_share(options, done, problem.discs().size());
        for (const std::uint32_t ray : map.find(done)) collector.add_hit(ray, done);
      }
    } catch (const Stopped&) {  // the unfinished disc is left out
    }
    outcome.counts = map.counts();
    if (done == problem.discs().size()) return collector.store_results(problem.rays().size());
    std::vector<std::uint32_t> first(done);
    std::iota(first.begin(), first.end(), 0U);
    collector.store_partial_results(first);
  }

  int leaf_;
};

}  // namespace

std::unique_ptr<Index> prepare_ray_map(const Problem&, const Parameters& parameters, const RunOptions&) {
  return std::make_unique<RayMapIndex>(std::get<RayMapParameters>(parameters).leaf);
}

}  // namespace detp::sim
