#include "disc_results.hpp"

#include <hwy/cache_control.h>

#include <atomic>
#include <utility>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/search/sort_pairs.hpp"

namespace detp::sim::stream {
namespace {

/// Sums of n equal powers, added one by one to 0, for n = 0, 1, 2, …
class RepeatedSums {
 public:
  RepeatedSums(double power, std::pmr::memory_resource* memory) : power_(power), sums_({0.0}, memory) {}

  /// The result of adding `count` more powers to `sum`, one by one.
  [[nodiscard]] double add(double sum, std::uint32_t count) {
    if (sum == 0) return from_zero(count);
    for (std::uint32_t i = 0; i < count; ++i) sum += power_;
    return sum;
  }

 private:
  double from_zero(std::size_t count) {
    while (sums_.size() <= count) sums_.push_back(sums_.back() + power_);
    return sums_[count];
  }

  double power_;
  std::pmr::vector<double> sums_;
};

template <class Element>
double bytes_of(const std::pmr::vector<Element>& array) {
  return static_cast<double>(array.size()) * sizeof(Element);
}

}  // namespace

DiscResults::DiscResults(const Problem& problem, const DiscTree& tree, const RunOptions& options, Outcome& outcome)
    : problem_(problem),
      tree_(tree),
      options_(options),
      outcome_(outcome),
      totals_(options.memory),
      hits_(tree.discs.size(), options.memory),
      snapshot_(options.memory) {
  if (options.totals != nullptr) ensure_totals();
}

void DiscResults::ensure_totals() {
  if (!totals_.empty()) return;
  totals_.resize(tree_.discs.size());
  if (options_.totals == nullptr || options_.totals->empty()) return;
  for (std::size_t place = 0; place < totals_.size(); ++place) totals_[place] = (*options_.totals)[tree_.order[place]];
}

BlockSearch DiscResults::begin(const Frame& frame, std::size_t first_ray, const RayTraits& traits) {
  const bool only_count = traits.power && !options_.pairs && !problem_.front_facing();
  const std::optional<double> power = only_count ? traits.power : std::nullopt;
  if (first_ray > 0 && power != counted_power_) add_counted_hits();
  counted_power_ = power;
  if (!only_count) ensure_totals();
  return {.problem = problem_,
          .frame = frame,
          .tree = tree_,
          .first_ray = static_cast<std::uint32_t>(first_ray),
          .segments = traits.segments,
          .pairs = options_.pairs,
          .vectors = options_.count,
          .hits = hits_.data(),
          .totals = only_count ? nullptr : totals_.data()};
}

void DiscResults::add_counted_hits() {
  ensure_totals();
  std::optional<RepeatedSums> sums;
  if (counted_power_) sums.emplace(*counted_power_, options_.memory);
  for (std::size_t place = 0; place < totals_.size(); ++place)
    for (int k = 0; k < classes; ++k) {
      const std::uint32_t count = std::exchange(hits_[place][static_cast<std::size_t>(k)], 0);
      totals_[place].hits += count;
      found_ += count;
      if (sums) totals_[place].power[k] = sums->add(totals_[place].power[k], count);
    }
}

void DiscResults::end_complete_block(const Block& block, std::uint64_t tests) {
  // A copy takes a few nanoseconds per disc, a test a sixth of a nanosecond. So copies take at most about a hundredth
  // of the time.
  constexpr std::uint64_t tests_for_each_disc = 4096;
  rays_ = block.first() + block.size();
  if (rays_ == problem_.rays().size() || tests - tests_at_snapshot_ < tests_for_each_disc * tree_.discs.size()) return;
  tests_at_snapshot_ = tests;
  if (has_room_for_snapshot()) take_snapshot();
}

/// If a copy of the results fits the memory budget, adds the bytes that it needs beyond those of the previous copy to
/// the outcome's bytes, and returns true. Otherwise returns false; a stopped run then returns the previous copy.
bool DiscResults::has_room_for_snapshot() {
  const double copy = bytes_of(hits_) + bytes_of(totals_);
  const double more = copy - bytes_of(snapshot_.counts) - bytes_of(snapshot_.totals);
  if (!fits_memory(outcome_.bytes + more, problem_)) return false;
  outcome_.bytes += more;
  return true;
}

void DiscResults::end_partial_block(const Block& block) {
  partial_ = true;
  by_discs_ = block.size() == problem_.rays().size() && options_.totals == nullptr;
}

std::uint64_t DiscResults::hits() const {
  std::uint64_t sum = found_;
  for (const ClassCounts& counts : hits_)
    for (const std::uint32_t count : counts) sum += count;
  return sum;
}

void DiscResults::take_snapshot() {
  const std::uint64_t found = hits();
  batches_.add(rays_ - snapshot_.rays, found - snapshot_.hits);
  snapshot_.rays = rays_;
  snapshot_.hits = found;
  snapshot_.totals = totals_;
  snapshot_.counts = hits_;
  snapshot_.counted_power = counted_power_;
  snapshot_.in_totals = found_;
}

void DiscResults::restore_snapshot() {
  rays_ = snapshot_.rays;
  totals_ = std::move(snapshot_.totals);
  hits_ = std::move(snapshot_.counts);
  hits_.resize(tree_.discs.size());
  counted_power_ = snapshot_.counted_power;
  found_ = snapshot_.in_totals;
}

void DiscResults::mark_done_discs(std::span<const DiscRun> skipped) const {
  outcome_.done_discs.assign(tree_.order.size(), true);
  for (const DiscRun& run : skipped)
    for (std::uint32_t place = run.first; place < run.first + run.count; ++place)
      outcome_.done_discs[tree_.order[place]] = false;
  keep_done_discs(outcome_);
}

void DiscResults::finish_outcome(std::span<const DiscRun> skipped) {
  if (partial_ && !by_discs_) restore_snapshot();
  totals_.empty() && counted_power_ ? store_counted() : store_totals();
  if (!options_.count) outcome_.counts = {};
  outcome_.counts.hits = outcome_.total_hits;
  outcome_.progress = {rays_, problem_.rays().size()};
  outcome_.stopped = rays_ < problem_.rays().size() || !sort_pairs(outcome_.pairs, options_.stop);
  if (outcome_.stopped) outcome_.pairs.clear();
  if (rays_ > snapshot_.rays) batches_.add(rays_ - snapshot_.rays, outcome_.total_hits - snapshot_.hits);
  outcome_.batches = batches_;
  if (by_discs_) mark_done_discs(skipped);
}

/// Fills in the outcome without totals, from counts of hits of equal power.
void DiscResults::store_counted() const {
  outcome_.hits.resize(hits_.size());
  outcome_.irradiance.resize(hits_.size());
  std::atomic<std::uint64_t> found = 0;
  sim::parallel_for(ParallelRange(0, hits_.size(), 1U << 14),
                    [&](const auto& range) { found += store_counted(range.begin(), range.end()); });
  outcome_.total_hits = found;
}

/// Fills in the outcome for the discs at places first … last - 1. Returns the number of their hits.
std::uint64_t DiscResults::store_counted(std::size_t first, std::size_t last) const {
  constexpr std::size_t prefetch_distance = 32;  // number of discs to prefetch
  RepeatedSums sums(*counted_power_, options_.memory);
  std::uint64_t found = 0;
  for (std::size_t place = first; place < last; ++place) {
    if (place + prefetch_distance < hits_.size()) {
      const std::uint32_t later = tree_.order[place + prefetch_distance];
      hwy::Prefetch(&problem_.discs()[later].radius);
      hwy::Prefetch(&outcome_.hits[later]);
      hwy::Prefetch(&outcome_.irradiance[later]);
    }
    const auto& [x, y, z] = hits_[place];
    if ((x | y | z) == 0) continue;  // the most frequent case with few rays
    const std::uint32_t disc = tree_.order[place];
    const DiscTotals totals{.hits = std::uint64_t{x} + y + z,
                            .power = {sums.add(0, x), sums.add(0, y), sums.add(0, z)}};
    outcome_.hits[disc] = totals.hits;
    outcome_.irradiance[disc] = irradiance(totals, problem_.discs()[disc]);
    found += totals.hits;
  }
  return found;
}

void DiscResults::store_totals() {
  add_counted_hits();
  outcome_.total_hits = found_;
  if (options_.totals != nullptr) {
    options_.totals->resize(totals_.size());
    for (std::size_t place = 0; place < totals_.size(); ++place)
      (*options_.totals)[tree_.order[place]] = totals_[place];
    return;
  }
  outcome_.hits.resize(totals_.size());
  outcome_.irradiance.resize(totals_.size());
  for (std::size_t place = 0; place < totals_.size(); ++place) {
    const std::uint32_t disc = tree_.order[place];
    outcome_.hits[disc] = totals_[place].hits;
    outcome_.irradiance[disc] = irradiance(totals_[place], problem_.discs()[disc]);
  }
}

}  // namespace detp::sim::stream
