#pragma once

#include <optional>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "irradiance.hpp"
#include "problem.hpp"
#include "run_memory.hpp"
#include "sort_pairs.hpp"

namespace detp::sim {

/// Counts the operations of a technique, or does nothing, at no cost, if counting is off.
template <bool counting>
class Tally {
 public:
  void add(std::uint64_t Counts<std::uint64_t>::*term, std::uint64_t amount = 1) {
    if constexpr (counting) counts_.*term += amount;
  }
  [[nodiscard]] const Counts<std::uint64_t>& counts() const { return counts_; }

 private:
  Counts<std::uint64_t> counts_;
};

/// Whether the ray counts as a hit of the disc, by the canonical predicate and the problem's front_facing.
[[nodiscard]] inline bool counts_as_hit(const Problem& problem, const Ray& ray, const Disc& disc) {
  return hits(ray, disc) && (!problem.front_facing() || arrives_in_front(ray, disc));
}

/// Decides by the canonical predicate, and collects the hits.
///
/// For each disc, a technique must add the hits in rising order of the rays' numbers. Then all techniques add powers in the
/// same order, and irradiance is the same to the last bit.
class HitCollector {
 public:
  /// Keeps references to all three. Adds to options.totals, unless it is null. Stores pairs in the outcome.
  HitCollector(const Problem& problem, const RunOptions& options, Outcome& outcome)
      : problem_(problem),
        options_(options),
        outcome_(outcome),
        first_photon_(sim::first_photon(options)),
        photon_blocks_(sim::photon_blocks(problem, options)),
        last_block_(last_block(problem, options)),
        own_(0, options.memory),
        blocks_(options.memory),
        units_(problem.bands(), options.memory) {
    if (options.standard_error) own_.keep_errors();
    totals().expect_powers(problem);
    for (std::size_t band = 0; band < problem.bands(); ++band) units_[band] = totals().band(band).unit();
    if (totals().empty()) totals().resize(problem.discs().size());
    if (last_block_ == totals().block()) return;
    totals().make_levels(problem.discs().size(), last_block_);
    blocks_.assign(problem.discs().size(), totals().block());
  }

  [[nodiscard]] bool is_hit(const Ray& ray, const Disc& disc) const { return counts_as_hit(problem_, ray, disc); }

  void add_hit(std::uint32_t ray, std::uint32_t disc) {
    const Ray& kept = problem_.rays()[ray];
    Totals& all = totals();
    if (!blocks_.empty()) fold(disc, photon_blocks_.of(problem_.photon(ray, first_photon_)));
    ++all[disc].hits;
    const int axis = dominant_axis(kept.direction);
    for (std::size_t band = 0; band < units_.size(); ++band) {
      Totals& sums = all.band(band);
      const double power = problem_.power(ray, band);
      if (sums.keeps_errors())
        sums.photon_sums(disc).add(problem_.photon(ray, first_photon_), axis, power, units_[band]);
      sums[disc].power[axis] += power;
    }
    ++kept_;
    if (options_.pairs) add_pair(outcome_.pairs, {ray, disc});
  }

  [[nodiscard]] std::uint64_t kept() const { return kept_; }

  /// Stores the results in the outcome; hits and irradiance only if options.totals is null. The first `rays` rays have
  /// been searched: fewer than all if the search was stopped.
  void store_results(std::uint64_t rays) {
    outcome_.progress = {rays, problem_.rays().size()};
    outcome_.stopped = rays < problem_.rays().size() || !sort_pairs(outcome_.pairs, options_.stop);
    outcome_.bytes += grown_bytes(outcome_.pairs.size(), sizeof(Pair));
    if (outcome_.stopped) outcome_.pairs.clear();
    outcome_.total_hits = kept_;
    outcome_.counts.hits = kept_;
    end_totals();
    if (outcome_.batches.count == 0 && rays > 0) outcome_.batches.add(rays, static_cast<double>(kept_));
    if (options_.totals == nullptr) finish(own_, problem_.discs(), outcome_);
    if (outcome_.stopped) outcome_.clear_errors();
  }

  /// Saves the caller's totals. To be called first by a search that may call store_partial_results.
  void save_totals() {
    if (options_.totals != nullptr) before_.emplace(*options_.totals, options_.memory);
  }

  /// Stores the results of a stopped search in the outcome. All rays have been tested against the discs in `done`, and
  /// some rays perhaps against other discs. If options.totals is not null, restores it and reports that no ray was
  /// searched, because totals cannot show that discs are missing.
  void store_partial_results(std::span<const std::uint32_t> done) {
    outcome_.stopped = true;
    outcome_.pairs.clear();
    if (options_.totals != nullptr) {
      *options_.totals = *before_;
      outcome_.progress = {0, problem_.rays().size()};
      return;
    }
    end_totals();
    finish(own_, problem_.discs(), outcome_);
    outcome_.done_discs.assign(problem_.discs().size(), false);
    for (const std::uint32_t disc : done) outcome_.done_discs[disc] = true;
    keep_done_discs(outcome_);
  }

 private:
  [[nodiscard]] Totals& totals() { return options_.totals == nullptr ? own_ : *options_.totals; }

  /// Moves a disc's sums on to a later block of photons.
  void fold(std::uint32_t disc, std::uint64_t block) {
    for (std::size_t band = 0; band < units_.size(); ++band) {
      Totals& all = totals().band(band);
      all.fold(disc, blocks_[disc], block, all[disc], all.keeps_errors() ? &all.photon_sums(disc) : nullptr);
    }
    blocks_[disc] = block;
  }

  /// Moves all discs on to the last block, and ends their photons.
  void end_totals() {
    Totals& all = totals();
    for (std::uint32_t disc = 0; disc < blocks_.size(); ++disc) fold(disc, last_block_);
    all.begin_block(last_block_);
    for (std::size_t band = 0; all.keeps_errors() && band < units_.size(); ++band)
      for (std::size_t disc = 0; disc < all.size(); ++disc) all.band(band).photon_sums(disc).close(units_[band]);
    all.add_rays(problem_);
  }

  const Problem& problem_;
  const RunOptions& options_;
  Outcome& outcome_;
  std::uint64_t first_photon_;
  PhotonBlocks photon_blocks_;
  std::uint64_t last_block_;
  std::optional<Totals> before_;  ///< the caller's totals before the search
  Totals own_;
  std::pmr::vector<std::uint64_t> blocks_;  ///< block under way of each disc; empty if all photons are in one
  std::uint64_t kept_ = 0;
  std::pmr::vector<double> units_;  ///< of the totals, by band
};

}  // namespace detp::sim
