#include <array>
#include <cmath>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "indexed_search.hpp"

namespace detp::sim {
namespace {

using Cell = std::array<std::int64_t, 3>;

/// Cubic cells over the box of the discs, and the discs of each cell in one array (compressed rows).
class Grid {
 public:
  Grid(const Problem& problem, int cells, Insertion insertion, const std::stop_token& stop)
      : slack_(problem.slack()), insertion_(insertion), box_(index_box(problem)) {
    const glm::dvec3 size = box_.size();
    side_ = std::max({size.x, size.y, size.z}) / cells;
    double total = 1;
    for (int axis = 0; axis < 3; ++axis) {
      along_[axis] =
          std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(size[axis] / side_ * (1 - 1e-12))), 1, cells);
      total *= static_cast<double>(along_[axis]);
    }
    require_memory("the grid's cells", 2 * (total + 1) * sizeof(std::size_t));
    starts_.assign(static_cast<std::size_t>(total) + 1, 0);
    fill(problem.discs(), stop);
  }

  [[nodiscard]] IndexSize size() const {
    return {.nodes = starts_.size() - 1,
            .references = references_.size(),
            .placements = references_.size(),
            .bytes = starts_.size() * sizeof(starts_[0]) + references_.size() * sizeof(references_[0]),
            .building_bytes = building_bytes(references_.size())};
  }

  [[nodiscard]] std::span<const std::uint32_t> references() const { return references_; }

  void visit_nodes(const VisitNode& visit) const {
    for (Cell cell{}; cell[2] < along_[2]; ++cell[2])
      for (cell[1] = 0; cell[1] < along_[1]; ++cell[1])
        for (cell[0] = 0; cell[0] < along_[0]; ++cell[0]) {
          const Box whole = box_of(cell);
          visit({{whole.low, glm::min(whole.high, box_.high)}, 0, true, references_in(index(cell)).size()});
        }
  }

  /// Steps from cell to cell along the ray. The place of each plane is recomputed from its number, so errors do not
  /// accumulate. A cell missed by rounding does no harm: discs near the cell's faces are also in the next cell.
  template <class Search>
  void trace(const Ray& traced, std::uint32_t ray, Search& search) const {
    const ClippedRay clipped(traced);
    const Box grown{box_.low - slack_, box_.high + slack_};
    const RayInterval interval = clipped.inside(grown);
    if (interval.empty()) return;
    Cell cell = cell_of(clipped.origin + interval.from * traced.direction);
    for (;;) {
      search.visit(&Counts<std::uint64_t>::steps);
      search.test(ray, references_in(index(cell)));
      int next = 0;
      double leave = unbounded;
      for (int axis = 0; axis < 3; ++axis)
        if (const double t = exit_distance(clipped, cell, axis); t < leave) {
          leave = t;
          next = axis;
        }
      if (!(leave < interval.to)) return;
      cell[next] += clipped.inverse[next] > 0 ? 1 : -1;
      if (cell[next] < 0 || cell[next] >= along_[next]) return;
    }
  }

 private:
  /// Distance at which the ray leaves the cell through a face across the axis; unbounded if parallel to that face.
  double exit_distance(const ClippedRay& ray, const Cell& cell, int axis) const {
    if (std::isinf(ray.inverse[axis])) return unbounded;
    const auto plane = static_cast<double>(cell[axis] + (ray.inverse[axis] > 0 ? 1 : 0));
    return (box_.low[axis] + plane * side_ - ray.origin[axis]) * ray.inverse[axis];
  }

  Cell cell_of(const glm::dvec3& point) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
      const double place = std::floor((point[axis] - box_.low[axis]) / side_);
      cell[axis] = static_cast<std::int64_t>(std::clamp(place, 0.0, static_cast<double>(along_[axis] - 1)));
    }
    return cell;
  }

  std::size_t index(const Cell& cell) const {
    return static_cast<std::size_t>((cell[2] * along_[1] + cell[1]) * along_[0] + cell[0]);
  }

  std::span<const std::uint32_t> references_in(std::size_t number) const {
    return std::span(references_).subspan(starts_[number], starts_[number + 1] - starts_[number]);
  }

  Box box_of(const Cell& cell) const {
    const glm::dvec3 low = box_.low + side_ * glm::dvec3{cell[0], cell[1], cell[2]};
    return {low, low + side_};
  }

  template <class Visit>
  void for_each_overlapped_cell(const Disc& disc, StopCheck& check, const Visit& visit) const {
    const Box reach = bounds(disc, slack_);
    const Cell low = cell_of(reach.low);
    const Cell high = cell_of(reach.high);
    for (std::int64_t z = low[2]; z <= high[2]; ++z)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
          check.after(1);
          if (low == high || insertion_ == Insertion::bounding_box || overlaps(disc, box_of({x, y, z}), slack_))
            visit(index({x, y, z}));
        }
  }

  struct Placement {
    std::size_t cell;
    std::uint32_t disc;
  };

  /// The larger of two peaks, in bytes: first the cells and the growing placements; then the cells twice, the
  /// placements and the references.
  [[nodiscard]] double building_bytes(std::size_t placements) const {
    constexpr double each = sizeof(Placement) + sizeof(std::uint32_t);
    const double cells = static_cast<double>(starts_.size()) * sizeof(starts_[0]);
    return std::max(cells + grown_bytes(placements, sizeof(Placement)),
                    2 * cells + each * static_cast<double>(placements));
  }

  /// Finds each disc's cells, and lists the discs cell by cell.
  void fill(std::span<const Disc> discs, const std::stop_token& stop) {
    StopCheck check(stop, "building the grid");
    check.now();
    std::vector<Placement> placements;
    for (std::uint32_t disc = 0; disc < discs.size(); ++disc) {
      for_each_overlapped_cell(discs[disc], check, [&](std::size_t cell) { placements.push_back({cell, disc}); });
      require_memory("the grid", building_bytes(placements.size()));
    }
    for_each_checked(std::span(placements), check, [&](const Placement& placement) { ++starts_[placement.cell + 1]; });
    std::size_t sum = 0;
    for_each_checked(std::span(starts_), check, [&](std::size_t& start) { start = sum += start; });
    references_.resize(placements.size());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for_each_checked(std::span(placements), check,
                     [&](const Placement& placement) { references_[next[placement.cell]++] = placement.disc; });
  }

  double slack_;
  Insertion insertion_;
  Box box_;
  double side_ = 0;
  Cell along_{1, 1, 1};
  std::vector<std::size_t> starts_;
  std::vector<std::uint32_t> references_;
};

}  // namespace

IndexSize inspect_grid(const Problem& problem, const GridParameters& parameters, const IndexVariant& variant,
                       const VisitNode& visit, const std::stop_token& stop) {
  check({Technique::grid, parameters});
  const Grid grid(problem, parameters.cells, variant.insertion, stop);
  grid.visit_nodes(visit);
  return grid.size();
}

std::unique_ptr<Index> index_grid(const Problem& problem, const GridParameters& parameters, const IndexVariant& variant,
                                  const RunOptions& options) {
  check({Technique::grid, parameters});
  return std::make_unique<TracedIndex<Grid>>("the grid", problem, options, variant.mailboxing, parameters.cells,
                                             variant.insertion);
}

std::unique_ptr<Index> prepare_grid(const Problem& problem, const Parameters& parameters, const RunOptions& options) {
  return index_grid(problem, std::get<GridParameters>(parameters), {}, options);
}

}  // namespace detp::sim
