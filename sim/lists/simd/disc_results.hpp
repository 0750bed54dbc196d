#pragma once

#include <algorithm>
#include <optional>

#include "block_search.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "ray_blocks.hpp"

namespace detp::sim::stream {

/// The results so far, disc by disc in the order of a DiscTree.
///
/// If all rays of a block have the same power, their hits are only counted (unless pairs, only front-facing hits, or
/// standard errors with photon numbers are requested). The counts are converted to sums of powers before a block with
/// another power, before another block of photons, and at the end. The sums have the same bits as if powers were added in
/// ray order.
///
/// After a stop request, a block may end with only some discs searched. The block's results are then dropped, and the
/// outcome is the latest copy of earlier results. Copies are made after some of the blocks. If one block has all rays
/// and options.totals is null, the outcome instead has the results of the discs that were searched.
class DiscResults {
 public:
  /// Keeps references to all four. Continues options.totals if it is not null.
  DiscResults(const Problem& problem, const DiscTree& tree, const RunOptions& options, Outcome& outcome);

  /// Prepares the search of a block of rays, and returns its data.
  [[nodiscard]] BlockSearch begin(const Frame& frame, const Block& rays);

  /// To be called after the search of a block.
  template <class Workers>
  void end(const Block& block, const Workers& workers) {
    const bool skipped =
        options_.stop.stop_requested() &&
        std::any_of(workers.begin(), workers.end(), [](const Worker& w) { return !w.skipped.empty(); });
    if (skipped) return end_partial_block(block);
    std::uint64_t tests = 0;
    for (const Worker& worker : workers) tests += detp::tests(worker.counts);
    end_complete_block(block, tests);
  }

  /// Fills in the outcome: pairs, the workers' counts, hits and irradiance. Unless options.totals is null, stores the
  /// sums there, in place of hits and irradiance.
  template <class Workers>
  void store_results(Workers& workers) {
    std::pmr::vector<DiscRun> skipped(options_.memory);
    for (Worker& worker : workers) {
      skipped.insert(skipped.end(), worker.skipped.begin(), worker.skipped.end());
      outcome_.counts += worker.counts;
      outcome_.vectors += worker.vectors;
    }
    if (options_.pairs && rays_ == problem_.rays().size()) store_pairs(workers);
    finish_outcome(skipped);
  }

 private:
  /// Sums in bands 1, 2, …, with which sums_ and photons_ are those of band 0.
  struct FurtherBands {
    explicit FurtherBands(std::pmr::memory_resource* memory) : sums(memory), photons(memory) {}
    std::pmr::vector<double> sums;         ///< as FurtherSums::sums
    std::pmr::vector<PhotonSums> photons;  ///< as FurtherSums::photons; empty unless errors are kept
  };

  /// A copy of the results after the first `rays` rays.
  struct Snapshot {
    explicit Snapshot(std::pmr::memory_resource* memory)
        : sums(memory), photons(memory), further(memory), counts(memory) {}
    std::size_t rays = 0;
    std::uint64_t hits = 0;
    std::pmr::vector<DiscTotals> sums;
    std::pmr::vector<PhotonSums> photons;
    FurtherBands further;
    std::pmr::vector<ClassCounts> counts;
    std::optional<Totals> earlier = {};  ///< only if the rays are of several blocks of photons
    std::optional<double> counted_power = {};
    std::uint64_t in_totals = 0;
  };

  /// Frees each worker's pairs after copying them.
  template <class Workers>
  void store_pairs(Workers& workers) {
    std::size_t count = 0;
    double bytes = 0;  // peak bytes while the workers' pairs grew
    for (const Worker& worker : workers) {
      count += worker.pairs.size();
      bytes += grown_bytes(worker.pairs.size(), sizeof(Pair));
    }
    outcome_.bytes += std::max(bytes, 2.0 * sizeof(Pair) * static_cast<double>(count));
    require_memory_for("the pairs", outcome_.bytes, problem_);
    outcome_.pairs.reserve(count);
    for (Worker& worker : workers) {
      outcome_.pairs.insert(outcome_.pairs.end(), worker.pairs.begin(), worker.pairs.end());
      FoundPairs(options_.memory).swap(worker.pairs);
    }
  }

  void end_complete_block(const Block& block, std::uint64_t tests);
  void end_partial_block(const Block& block);
  [[nodiscard]] bool has_room_for_snapshot();
  void take_snapshot();
  [[nodiscard]] std::uint64_t hits() const;
  void restore_snapshot();
  void mark_done_discs(std::span<const DiscRun> skipped) const;
  void finish_outcome(std::span<const DiscRun> skipped);
  [[nodiscard]] Totals& totals() { return options_.totals == nullptr ? own_ : *options_.totals; }
  void ensure_sums();
  [[nodiscard]] PhotonSums* photons_of(std::size_t place, std::size_t band);
  [[nodiscard]] DiscTotals sums_of(std::size_t place, std::size_t band) const;
  void set_power(std::size_t place, std::size_t band, const glm::dvec3& power);
  [[nodiscard]] double counted_power(std::size_t band) const {
    return band == 0 ? *counted_power_ : problem_.power(0, band);
  }
  void begin_photons(std::size_t first_ray);
  void add_counted_hits();
  std::uint64_t add_counted_hits(std::size_t first, std::size_t last);
  void add_counted_powers(std::size_t first, std::size_t last, std::size_t band);
  void store_counted() const;
  [[nodiscard]] std::uint64_t store_counted(std::size_t first, std::size_t last) const;
  void store_counted(std::size_t first, std::size_t last, std::size_t band) const;
  void store_further_sums(std::span<const std::uint32_t> place_of, std::size_t first, std::size_t last) const;
  void store_totals();

  const Problem& problem_;
  const DiscTree& tree_;
  const RunOptions& options_;
  Outcome& outcome_;
  Totals own_;                         ///< if options.totals is null; has only the sums over earlier blocks of photons
  std::pmr::vector<DiscTotals> sums_;  ///< of the block of photons under way; empty while hits have only been counted
  std::pmr::vector<PhotonSums> photons_;  ///< empty unless errors are kept
  FurtherBands further_;
  std::pmr::vector<double> units_;       ///< of bands 1, 2, …
  std::pmr::vector<ClassCounts> hits_;   ///< hits that are not yet in the sums
  std::optional<double> counted_power_;  ///< power of each ray in hits_; nullopt if these powers are in the sums
  std::uint64_t found_ = 0;              ///< hits in the sums, not including those of earlier runs
  std::size_t rays_ = 0;                 ///< all discs have been searched for the first rays_ rays
  bool partial_ = false;                 ///< the last block ended with only some discs searched
  bool by_discs_ = false;                ///< partial_, and that block has all rays: some discs are complete
  std::uint64_t first_photon_;
  std::uint64_t last_block_;  ///< of photons
  std::uint64_t tests_at_snapshot_ = 0;
  Snapshot snapshot_;
  Batches batches_;
};

}  // namespace detp::sim::stream
