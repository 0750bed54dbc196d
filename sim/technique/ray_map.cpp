#include <algorithm>
#include <numeric>
#include <optional>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "detp/sim/index/indexed_search.hpp"
#include "detp/sim/lists/simd/search.hpp"
#include "detp/sim/search/hit_collector.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "ray_map_lists.hpp"
#include "technique.hpp"

namespace detp::sim {
namespace {

/// A kd-tree over rays. When a disc searches a cell, the cell is halved across its longest side if it has more rays
/// than `leaf` and is longer than the largest disc is wide. (In a smaller cell, a disc would search most of the parts.)
/// A cell is not halved if most of its rays would be in both halves, for instance if the rays coincide.
/// `Lists` are PlainRays or VectorRays.
///
/// Source  V. Havran, J. Bittner, H.-P. Seidel: Ray Maps for Global Illumination (2004); the splitting rule is ours.
template <bool counting, class Lists>
class RayMap {
 public:
  /// `lists` are further arguments of the Lists.
  RayMap(const Problem& problem, const RunOptions& options, int leaf, const auto&... lists)
      : problem_(problem),
        leaf_(static_cast<std::size_t>(leaf)),
        check_(options.stop, "searching"),
        lists_(problem, options, lists...),
        cells_(options.memory),
        found_(options.memory) {
    narrowest_ = 8 * problem.slack();  // includes the growth of both halves
    for (const Disc& disc : problem.discs()) narrowest_ = std::max(narrowest_, 2 * disc.radius);
    cells_.push_back({index_box(problem), lists_.all()});
  }

  /// The rays that hit the disc, in rising order of their numbers.
  const std::pmr::vector<std::uint32_t>& find(std::uint32_t disc) {
    found_.clear();
    search_node(0, disc, bounds(problem_.discs()[disc], 2 * problem_.slack()));
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return found_;
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const {
    Counts<std::uint64_t> counts = tally_.counts();
    if (counting) counts.doubtful = lists_.doubtful();
    return counts;
  }

 private:
  /// A cell with the rays that cross it, or two halves.
  struct Cell {
    Box box;
    std::optional<typename Lists::List> rays;  ///< none once the cell is split
    std::uint32_t first = 0;                   ///< number of the lower half, which the upper half follows; 0: not split
    bool final = false;                        ///< splitting it does not separate its rays

    [[nodiscard]] bool is_split() const { return first != 0; }
  };

  void search_node(std::uint32_t number, std::uint32_t disc, const Box& reach) {
    tally_.add(&Counts<std::uint64_t>::nodes);
    check_.after(1);
    if (!cells_[number].is_split() && should_split(cells_[number])) split(number);
    if (!cells_[number].is_split()) {
      tally_.add(&Counts<std::uint64_t>::visits);
      tally_.add(&Counts<std::uint64_t>::disc_tests, lists_.test(*cells_[number].rays, disc, found_));
      return;
    }
    for (const std::uint32_t half : {cells_[number].first, cells_[number].first + 1})
      if (overlap(cells_[half].box, reach)) search_node(half, disc, reach);
  }

  [[nodiscard]] static bool overlap(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
  }

  [[nodiscard]] bool should_split(const Cell& cell) const {
    const glm::dvec3 size = cell.box.size();
    return !cell.final && lists_.size(*cell.rays) > leaf_ && std::max({size.x, size.y, size.z}) > narrowest_;
  }

  /// One half of a cell, with the rays that meet the half grown by the slack. Rays near the middle are in both halves.
  [[nodiscard]] Cell half_of(const Cell& cell, int axis, bool upper) {
    Box box = cell.box;
    (upper ? box.low : box.high)[axis] = cell.box.centre()[axis];
    Cell half{box, lists_.inside(*cell.rays, {box.low - problem_.slack(), box.high + problem_.slack()})};
    tally_.add(&Counts<std::uint64_t>::culls);
    tally_.add(&Counts<std::uint64_t>::cull_tests, lists_.size(*cell.rays));
    tally_.add(&Counts<std::uint64_t>::listed, lists_.size(*half.rays));
    return half;
  }

  void split(std::uint32_t number) {
    const glm::dvec3 size = cells_[number].box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    Cell lower = half_of(cells_[number], axis, false);
    Cell upper = half_of(cells_[number], axis, true);
    constexpr double most_twice = 1.9;  // entries in the halves' lists, per ray; a line meets 4/3 halves of a cube
    const std::size_t before = lists_.size(*cells_[number].rays);
    const std::size_t in_halves = lists_.size(*lower.rays) + lists_.size(*upper.rays);
    cells_[number].final = static_cast<double>(in_halves) > most_twice * static_cast<double>(before);
    if (cells_[number].final) return;
    listed_ += in_halves;
    listed_ -= std::min(listed_, before);
    cells_[number].rays.reset();
    cells_[number].first = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back(std::move(lower));
    cells_.push_back(std::move(upper));
    require_memory_for("the ray map",
                       grown_bytes(cells_.size(), sizeof(Cell)) + lists_.bytes(listed_ + problem_.rays().size()),
                       problem_);
  }

  const Problem& problem_;
  std::size_t leaf_;
  StopCheck check_;
  Tally<counting> tally_;
  double narrowest_ = 0;  ///< shorter cells are not split
  Lists lists_;
  std::pmr::vector<Cell> cells_;
  std::size_t listed_ = 0;  ///< rays in cells that are not split, except the root
  std::pmr::vector<std::uint32_t> found_;
};

/// Each disc looks up the rays that cross it. Builds nothing before the rays are known. The search runs on one thread.
class RayMapIndex final : public Index {
 public:
  RayMapIndex(const Problem& problem, const RunOptions& options, int leaf) : leaf_(leaf) {
    if (options.engine != Engine::simd || !stream::can_search(problem)) return;
    const Stopwatch watch;
    const std::size_t count = problem.discs().size();
    built_.bytes = checked_bytes(
        what, static_cast<double>(sizeof(stream::FloatDisc) + 2 * sizeof(std::uint32_t)) * static_cast<double>(count),
        problem);
    UnsetVector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    frame_.emplace(problem);
    floats_ = stream::discs_in_order(problem, *frame_, std::move(order), options);
    built_.seconds.build = watch.seconds();
  }

  [[nodiscard]] bool sorts_rays() const override { return true; }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    const double lists = frame_ ? VectorRays::bytes_before_splits(problem) : PlainRays::bytes_before_splits(problem);
    add_checked_bytes(what, built_.bytes + lists + 2 * found_bytes(problem, options), problem, outcome);
    options.count ? search_all<true>(problem, options, outcome) : search_all<false>(problem, options, outcome);
  }

 private:
  static constexpr const char* what = "the ray map";

  template <bool counting>
  void search_all(const Problem& problem, const RunOptions& options, Outcome& outcome) const {
    if (frame_)
      search_discs(RayMap<counting, VectorRays>(problem, options, leaf_, *frame_, floats_), problem, options, outcome);
    else
      search_discs(RayMap<counting, PlainRays>(problem, options, leaf_), problem, options, outcome);
  }

  static void search_discs(auto map, const Problem& problem, const RunOptions& options, Outcome& outcome) {
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
  std::optional<stream::Frame> frame_;  ///< of the simd engine
  stream::DiscTree floats_;             ///< of the simd engine; in the problem's order
};

}  // namespace

std::unique_ptr<Index> prepare_ray_map(const Problem& problem, const Parameters& parameters,
                                       const RunOptions& options) {
  return std::make_unique<RayMapIndex>(problem, options, std::get<RayMapParameters>(parameters).leaf);
}

}  // namespace detp::sim
