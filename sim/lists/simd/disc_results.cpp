#include "disc_results.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <numbers>
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

/// Writes places of discs with hits, from `place` on, to `found` until it is full; moves `place` behind the last that was looked at.
/// Returns their number. With few rays, most discs have none.
std::size_t find_hits(std::span<const ClassCounts> hits, std::size_t& place, std::size_t last,
                      std::span<std::uint32_t> found) {
  std::size_t count = 0;
  std::size_t at = place;
  for (; at < last && count < found.size(); ++at) {
    found[count] = static_cast<std::uint32_t>(at);
    count += (hits[at][0] | hits[at][1] | hits[at][2]) != 0 ? 1 : 0;
  }
  place = at;
  return count;
}

/// Calls visit(place) for all places, in parallel. Some places before that, calls fetch(place): what the visit will use, in another order than that of
/// the places, is then on its way from memory.
template <class Fetch, class Visit>
void for_each_place(std::size_t places, const Fetch& fetch, const Visit& visit) {
  constexpr std::size_t at_once = std::size_t{1} << 14;
  constexpr std::size_t ahead = 16;
  sim::parallel_for(ParallelRange(0, places, at_once), [&](const ParallelRange& part) {
    for (std::size_t place = part.begin(); place < part.end(); ++place) {
      fetch(std::min(place + ahead, part.end() - 1));
      visit(place);
    }
  });
}

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
      own_(0, options.memory),
      sums_(options.memory),
      photons_(options.memory),
      hits_(tree.discs.size(), options.memory),
      first_photon_(first_photon(options)),
      last_block_(last_block(problem, options)),
      snapshot_(options.memory) {
  if (options.standard_error) own_.keep_errors();
  totals().expect_powers(problem.largest_power());
  if (options.totals != nullptr) ensure_sums();
  if (totals().block() == last_block_) return;
  ensure_sums();
  totals().make_levels(tree_.discs.size(), last_block_);
  snapshot_.earlier.emplace(totals(), options.memory);
}

void DiscResults::ensure_sums() {
  if (!sums_.empty()) return;
  sums_.resize(tree_.discs.size());
  if (totals().keeps_errors()) photons_.resize(tree_.discs.size());
  if (options_.totals == nullptr) return;
  if (totals().empty()) totals().resize(tree_.discs.size());
  const Totals& all = totals();
  for_each_place(
      sums_.size(),
      [&](std::size_t place) {
        hwy::Prefetch(&all[tree_.order[place]]);
        if (!photons_.empty()) hwy::Prefetch(&all.photon_sums(tree_.order[place]));
      },
      [&](std::size_t place) {
        sums_[place] = all[tree_.order[place]];
        if (!photons_.empty()) photons_[place] = all.photon_sums(tree_.order[place]);
      });
}

/// Moves the sums of earlier blocks of photons into the totals.
void DiscResults::begin_photons(std::size_t first_ray) {
  const std::uint64_t before = totals().block();
  const std::uint64_t block = photon_blocks(problem_, options_).of(problem_.photon(first_ray, first_photon_));
  if (block == before) return;
  add_counted_hits();
  Totals& all = totals();
  for_each_place(
      sums_.size(), [&](std::size_t place) { all.prefetch(tree_.order[place], before); },
      [&](std::size_t place) {
        all.fold(tree_.order[place], before, block, sums_[place], photons_.empty() ? nullptr : &photons_[place]);
      });
  totals().begin_block(block);
}

BlockSearch DiscResults::begin(const Frame& frame, const Block& rays) {
  const std::size_t first_ray = rays.first();
  begin_photons(first_ray);
  const bool errors = totals().keeps_errors();
  const bool only_count =
      rays.traits().power && !options_.pairs && !problem_.front_facing() && !(errors && problem_.numbered());
  const std::optional<double> power = only_count ? rays.traits().power : std::nullopt;
  if (first_ray > 0 && power != counted_power_) add_counted_hits();
  counted_power_ = power;
  if (!only_count || errors) ensure_sums();
  return {.problem = problem_,
          .frame = frame,
          .tree = tree_,
          .first_ray = static_cast<std::uint32_t>(first_ray),
          .segments = rays.traits().segments,
          .pairs = options_.pairs,
          .vectors = options_.count,
          .hits = hits_.data(),
          .totals = only_count ? nullptr : sums_.data(),
          .photons = errors && !only_count ? photons_.data() : nullptr,
          .powers = rays.powers(),
          .unit = totals().unit()};
}

void DiscResults::add_counted_hits() {
  ensure_sums();
  std::atomic<std::uint64_t> found = 0;
  sim::parallel_for(ParallelRange(0, sums_.size(), 1U << 14),
                    [&](const auto& range) { found += add_counted_hits(range.begin(), range.end()); });
  found_ += found;
}

/// The same for the discs at places first … last - 1. Returns the number of their hits.
std::uint64_t DiscResults::add_counted_hits(std::size_t first, std::size_t last) {
  std::uint64_t found = 0;
  std::optional<RepeatedSums> sums;
  std::optional<RepeatedSums> squares;
  if (counted_power_) sums.emplace(*counted_power_, options_.memory);
  if (counted_power_ && !photons_.empty()) {
    const double power = totals().unit() * *counted_power_;
    squares.emplace(power * power, options_.memory);
  }
  for (std::size_t place = first; place < last; ++place) {
    PhotonSums* const photons = squares ? &photons_[place] : nullptr;
    std::uint32_t added = 0;
    for (int k = 0; k < classes; ++k) {
      const std::uint32_t count = std::exchange(hits_[place][static_cast<std::size_t>(k)], 0);
      if (sums) sums_[place].power[k] = sums->add(sums_[place].power[k], count);
      if (photons != nullptr) photons->squares[k] = squares->add(photons->squares[k], count);
      added += count;
    }
    sums_[place].hits += added;
    found += added;
    if (photons == nullptr || added == 0) continue;
    photons->largest = std::max(photons->largest, *counted_power_);
    photons->add_photons(added);
  }
  return found;
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
  const double copy = bytes_of(hits_) + bytes_of(sums_) + bytes_of(photons_);
  const double more = copy - bytes_of(snapshot_.counts) - bytes_of(snapshot_.sums) - bytes_of(snapshot_.photons);
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
  batches_.add(rays_ - snapshot_.rays, static_cast<double>(found - snapshot_.hits));
  snapshot_.rays = rays_;
  snapshot_.hits = found;
  snapshot_.sums = sums_;
  snapshot_.photons = photons_;
  if (snapshot_.earlier) *snapshot_.earlier = totals();
  snapshot_.counts = hits_;
  snapshot_.counted_power = counted_power_;
  snapshot_.in_totals = found_;
}

void DiscResults::restore_snapshot() {
  rays_ = snapshot_.rays;
  sums_ = std::move(snapshot_.sums);
  photons_ = std::move(snapshot_.photons);
  if (snapshot_.earlier) totals() = *snapshot_.earlier;
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
  sums_.empty() && counted_power_ ? store_counted() : store_totals();
  if (!options_.count) outcome_.counts = {};
  outcome_.counts.hits = outcome_.total_hits;
  outcome_.progress = {rays_, problem_.rays().size()};
  outcome_.stopped = rays_ < problem_.rays().size() || !sort_pairs(outcome_.pairs, options_.stop);
  if (outcome_.stopped) outcome_.pairs.clear();
  if (rays_ > snapshot_.rays)
    batches_.add(rays_ - snapshot_.rays, static_cast<double>(outcome_.total_hits - snapshot_.hits));
  outcome_.batches = batches_;
  if (outcome_.stopped) outcome_.standard_error.clear();
  if (outcome_.stopped) outcome_.upper_bound.clear();
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
  RepeatedSums sums(*counted_power_, options_.memory);
  const std::span<const Disc> discs = problem_.discs();
  std::array<std::uint32_t, 64> with_hits;  // places whose results are fetched from memory together
  std::uint64_t found = 0;
  for (std::size_t place = first; place < last;) {
    const std::size_t count = find_hits(hits_, place, last, with_hits);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t disc = tree_.order[with_hits[i]];
      hwy::Prefetch(&discs[disc].radius);
      hwy::Prefetch(&outcome_.hits[disc]);
      hwy::Prefetch(&outcome_.irradiance[disc]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t disc = tree_.order[with_hits[i]];
      const auto& [x, y, z] = hits_[with_hits[i]];
      outcome_.hits[disc] = std::uint64_t{x} + y + z;
      const double power = (sums.add(0, x) + sums.add(0, y)) + sums.add(0, z);
      const double radius = discs[disc].radius;
      outcome_.irradiance[disc] = power / (std::numbers::pi * radius * radius / problem_.scale());
      found += outcome_.hits[disc];
    }
  }
  return found;
}

void DiscResults::store_totals() {
  add_counted_hits();
  outcome_.total_hits = found_;
  totals().add_rays(problem_);
  const bool own = options_.totals == nullptr;
  if (own) resize_results(sums_.size(), !photons_.empty(), outcome_);
  for (PhotonSums& photons : photons_) photons.close(totals().unit());
  const double heaviest = heaviest_photon(photons_, problem_.largest_power());
  Totals& all = totals();
  // Where nothing hits, the results are 0 already.
  const auto is_zero = [&](std::size_t place) { return photons_.empty() && sums_[place].hits == 0; };
  const auto fetch = [&](std::size_t place) {
    const std::uint32_t disc = tree_.order[place];
    if (!own) {
      hwy::Prefetch(&all[disc]);
      return;
    }
    if (is_zero(place)) return;
    hwy::Prefetch(&problem_.discs()[disc].radius);
    hwy::Prefetch(&outcome_.hits[disc]);
    hwy::Prefetch(&outcome_.irradiance[disc]);
  };
  for_each_place(sums_.size(), fetch, [&](std::size_t place) {
    const std::uint32_t disc = tree_.order[place];
    const PhotonSums* const photons = photons_.empty() ? nullptr : &photons_[place];
    if (own) {
      if (is_zero(place)) return;
      finish_disc(own_, problem_.discs()[disc], disc, sums_[place], photons, heaviest, outcome_);
    } else {
      all[disc] = sums_[place];
      if (photons != nullptr) all.photon_sums(disc) = *photons;
    }
  });
}

}  // namespace detp::sim::stream
