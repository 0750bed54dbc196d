#pragma once

#include <algorithm>
#include <bit>

#include "cell_discs.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/search/hit_collector.hpp"
#include "detp/sim/search/outcome.hpp"

namespace detp::sim {

/// Tests rays one by one against groups of discs, in vectors of floats; what floats leave in doubt is decided in double. A disc that comes
/// several times for one ray is recorded once.
template <bool counting>
class VectorTests {
 public:
  VectorTests(const Problem& problem, const stream::Frame& frame, const RunOptions& options)
      : problem_(problem),
        frame_(frame),
        decide_(decide_cells(problem.segments(), problem.front_facing())),
        check_(options.stop, "searching"),
        rays_(options.memory),
        last_hit_(problem.discs().size(), 0, options.memory) {}

  /// The rays from `first` to the one before `last` come next. Their hits are appended to `hits`.
  void load(std::uint32_t first, std::uint32_t last, FoundPairs& hits) {
    first_ = first;
    hits_ = &hits;
    rays_.load(problem_.rays().subspan(first, last - first), frame_);
  }

  void begin(std::uint32_t ray) {
    ray_ = ray;
    now_ = &rays_[ray - first_];
  }

  void visit(std::uint64_t Counts<std::uint64_t>::*term) { tally_.add(term); }

  /// Tests the ray against these discs. `floats` are the same discs, and CellDiscs::padding more that can be read. Throws Stopped if a
  /// stop was requested.
  void test(std::span<const std::uint32_t> discs, const stream::FloatDisc* floats) {
    tally_.add(&Counts<std::uint64_t>::disc_tests, discs.size());
    check_.after(1);
    if (now_->axis == stream::classes) return;  // far from all discs
    for (std::size_t i = 0; i < discs.size(); i += most_decided) {
      const std::size_t count = std::min(most_decided, discs.size() - i);
      const CellDecision decision = decide_[now_->axis](*now_, floats + i, count);
      check_.after(count);
      for (std::uint64_t left = decision.sure | decision.unsure; left != 0; left &= left - 1) {
        const auto place = static_cast<std::size_t>(std::countr_zero(left));
        record(discs[i + place], (decision.sure >> place & 1) != 0);
      }
    }
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const { return tally_.counts(); }

 private:
  void record(std::uint32_t disc, bool sure) {
    if (!sure) tally_.add(&Counts<std::uint64_t>::doubtful);
    if (last_hit_[disc] == ray_ + 1) return;
    if (!sure && !counts_as_hit(problem_, problem_.rays()[ray_], problem_.discs()[disc])) return;
    last_hit_[disc] = ray_ + 1;
    hits_->push_back({ray_, disc});
  }

  const Problem& problem_;
  const stream::Frame& frame_;
  DecideCells decide_;
  StopCheck check_;
  Tally<counting> tally_;
  FloatRays rays_;
  const FloatRay* now_ = nullptr;
  std::uint32_t first_ = 0;
  std::uint32_t ray_ = 0;
  std::pmr::vector<std::uint32_t> last_hit_;  ///< for each disc: 1 + the last ray that hit it; 0: none yet
  FoundPairs* hits_ = nullptr;
};

}  // namespace detp::sim
