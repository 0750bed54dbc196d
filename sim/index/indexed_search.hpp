#pragma once

#include <algorithm>
#include <optional>

#include "cell_discs.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/lists/simd/search.hpp"
#include "detp/sim/search/hit_collector.hpp"
#include "detp/sim/search/index.hpp"
#include "detp/sim/search/ray_search.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "disc_index.hpp"
#include "vector_tests.hpp"

namespace detp::sim {

/// Traces rays through an index, and tests each ray against the discs of the cells that it enters. A hit is recorded
/// once, even if several of these cells list the disc. With mailboxes, each disc notes the last ray that was tested
/// against it, so disc_tests counts a pair of ray and disc once. Without, disc_tests counts the pair in each of these
/// cells, even where the hit is already known.
///
/// `Cells` provides size(), references() (of all cells), and trace(ray, number, search), which calls the search's visit and test.
template <bool counting, bool mailboxing, class Cells>
class IndexedSearch final : public RaySearch {
 public:
  IndexedSearch(const Cells& index, const Problem& problem, const RunOptions& options)
      : index_(index),
        problem_(problem),
        check_(options.stop, "searching"),
        last_ray_(problem.discs().size(), 0, options.memory) {}

  void search(std::uint32_t first, std::uint32_t last, FoundPairs& hits) override {
    hits_ = &hits;
    for (std::uint32_t ray = first; ray < last; ++ray) index_.trace(problem_.rays()[ray], ray, *this);
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const override { return tally_.counts(); }

  /// Counts a visit to a cell (steps) or a node (nodes).
  void visit(std::uint64_t Counts<std::uint64_t>::*term) { tally_.add(term); }

  /// Throws Stopped if a stop was requested.
  void test(std::uint32_t ray, std::span<const std::uint32_t> discs) {
    for (; discs.size() >= StopCheck::most_work; discs = discs.subspan(StopCheck::most_work - 1))
      test_some(ray, discs.first(StopCheck::most_work - 1));
    test_some(ray, discs);
  }

 private:
  void test_some(std::uint32_t ray, std::span<const std::uint32_t> discs) {
    check_.after(discs.size() + 1);
    const Ray& tested = problem_.rays()[ray];
    std::uint64_t known = 0;
    for (const std::uint32_t disc : discs) {
      const bool seen = last_ray_[disc] == ray + 1;
      if (mailboxing && seen) ++known;
      if (seen) continue;
      const bool hit = counts_as_hit(problem_, tested, problem_.discs()[disc]);
      if (mailboxing || hit) last_ray_[disc] = ray + 1;
      if (hit) hits_->push_back({ray, disc});
    }
    tally_.add(&Counts<std::uint64_t>::disc_tests, discs.size() - known);
  }

  const Cells& index_;
  const Problem& problem_;
  StopCheck check_;
  Tally<counting> tally_;
  std::pmr::vector<std::uint32_t> last_ray_;  ///< for each disc: 1 + the last ray that was decided for it; 0: none yet
  FoundPairs* hits_ = nullptr;
};

/// The same search with vectors: the hits of IndexedSearch, and its counts without mailboxes; also counts the decisions that floats left
/// in doubt.
template <bool counting, class Cells>
class VectorSearch final : public RaySearch {
 public:
  VectorSearch(const Cells& index, const CellDiscs& discs, const Problem& problem, const RunOptions& options)
      : index_(index), discs_(discs), problem_(problem), tests_(problem, discs.frame(), options) {}

  void search(std::uint32_t first, std::uint32_t last, FoundPairs& hits) override {
    tests_.load(first, last, hits);
    for (std::uint32_t ray = first; ray < last; ++ray) {
      tests_.begin(ray);
      index_.trace(problem_.rays()[ray], ray, *this);
    }
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const override { return tests_.counts(); }

  void visit(std::uint64_t Counts<std::uint64_t>::*term) { tests_.visit(term); }

  /// Throws Stopped if a stop was requested.
  void test(std::uint32_t /*ray*/, std::span<const std::uint32_t> discs) {
    tests_.test(discs, discs_.discs() + (discs.data() - index_.references().data()));
  }

 private:
  const Cells& index_;
  const CellDiscs& discs_;
  const Problem& problem_;
  VectorTests<counting> tests_;
};

/// An index of cells over discs, and its search. `Cells` is constructed from the problem, `arguments` and the stop
/// token.
template <class Cells>
class TracedIndex final : public Index {
 public:
  template <class... Arguments>
  TracedIndex(std::string_view what, const Problem& problem, const RunOptions& options, bool mailboxing,
              const Arguments&... arguments)
      : what_(what), mailboxing_(mailboxing), cells_(problem, arguments..., options.stop) {
    const IndexSize size = cells_.size();
    if (!mailboxing && options.engine == Engine::simd && stream::can_search(problem)) {
      require_memory_for(what, static_cast<double>(size.bytes) + CellDiscs::bytes(size.references), problem);
      discs_.emplace(problem, cells_.references(), options.stop);
    }
    built_.seconds.build = watch_.lap();
    built_.counts.references = size.references;
    built_.counts.placements = size.placements;
    built_.bytes =
        checked_bytes(what, std::max(size.building_bytes, static_cast<double>(size.bytes) + disc_bytes()), problem);
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    add_checked_bytes(what_, searching_bytes(problem, options), problem, outcome);
    if (discs_)
      return options.count ? trace_in_vectors<true>(problem, options, outcome)
                           : trace_in_vectors<false>(problem, options, outcome);
    if (mailboxing_)
      options.count ? trace_all<true, true>(problem, options, outcome)
                    : trace_all<false, true>(problem, options, outcome);
    else
      options.count ? trace_all<true, false>(problem, options, outcome)
                    : trace_all<false, false>(problem, options, outcome);
  }

 private:
  /// Bytes of the index, the mailboxes of its search, the sums and the outcome.
  [[nodiscard]] double searching_bytes(const Problem& problem, const RunOptions& options) const {
    const double mailboxes = thread_count(options.threads) * static_cast<double>(sizeof(std::uint32_t)) *
                             static_cast<double>(problem.discs().size());
    return static_cast<double>(cells_.size().bytes) + disc_bytes() + mailboxes + found_bytes(problem, options);
  }

  [[nodiscard]] double disc_bytes() const { return discs_ ? CellDiscs::bytes(cells_.size().references) : 0; }

  template <bool counting>
  void trace_in_vectors(const Problem& problem, const RunOptions& options, Outcome& outcome) const {
    search_rays(
        problem, options,
        [&] {
          return make_in<RaySearch, VectorSearch<counting, Cells>>(*options.memory, cells_, *discs_, problem, options);
        },
        outcome);
  }

  template <bool counting, bool mailboxing>
  void trace_all(const Problem& problem, const RunOptions& options, Outcome& outcome) const {
    search_rays(
        problem, options,
        [&] {
          return make_in<RaySearch, IndexedSearch<counting, mailboxing, Cells>>(*options.memory, cells_, problem,
                                                                                options);
        },
        outcome);
  }

  Stopwatch watch_;
  std::string_view what_;
  bool mailboxing_;
  Cells cells_;
  std::optional<CellDiscs> discs_;  ///< of the simd engine
};

/// The box around the discs' centres, grown by the largest radius, so that it contains every disc.
[[nodiscard]] inline Box index_box(std::span<const Disc> discs) {
  Box box;
  double largest = 0;
  for (const Disc& disc : discs) {
    box.include(disc.centre);
    largest = std::max(largest, disc.radius);
  }
  return {box.low - largest, box.high + largest};
}

/// The box that the cells of an index fill. Each of its faces is more than 2 slacks outside the discs' box. So a ray
/// that runs along a face of the discs' box, or just outside it, is inside the cells of the discs that touch this face
/// where it passes them (sim/geometry/proofs.md, "The culls").
///
/// In man-made scenes, discs often lie exactly on the planes that cut the discs' box into N equal parts, with a small
/// N. The margin moves plane number j of these (0 <= j <= N) by 2.618 (2j/N - 1) slacks. This distance must not be
/// exactly one slack: rounding would then decide which cells these discs overlap.
[[nodiscard]] inline Box index_box(const Problem& problem) {
  constexpr double slacks = 2.618;
  const Box box = index_box(problem.discs());
  return {box.low - slacks * problem.slack(), box.high + slacks * problem.slack()};
}

}  // namespace detp::sim
