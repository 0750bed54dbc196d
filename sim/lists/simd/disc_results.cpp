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

/// Calls visit(place, band) for all places and bands, in parallel. Some places before that, calls fetch(place, band): what the visit will use, in another
/// order than that of the places, is then on its way from memory. Some places at a time, so that their rows of sums stay in the cache.
template <class Fetch, class Visit>
void for_each_place(std::size_t places, std::size_t bands, const Fetch& fetch, const Visit& visit) {
  constexpr std::size_t at_once = std::size_t{1} << 14;
  constexpr std::size_t ahead = 16;
  const std::size_t in_cache = bands == 1 ? at_once : 256;
  sim::parallel_for(ParallelRange(0, places, at_once), [&](const ParallelRange& part) {
    for (std::size_t first = part.begin(); first < part.end(); first += in_cache) {
      const std::size_t end = std::min(part.end(), first + in_cache);
      for (std::size_t band = 0; band < bands; ++band)
        for (std::size_t place = first; place < end; ++place) {
          fetch(std::min(place + ahead, part.end() - 1), band);
          visit(place, band);
        }
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
      further_(options.memory),
      units_(options.memory),
      hits_(tree.discs.size(), options.memory),
      first_photon_(first_photon(options)),
      last_block_(last_block(problem, options)),
      snapshot_(options.memory) {
  if (options.standard_error) own_.keep_errors();
  totals().expect_powers(problem);
  for (std::size_t band = 1; band < problem.bands(); ++band) units_.push_back(totals().band(band).unit());
  if (options.totals != nullptr) ensure_sums();
  if (totals().block() == last_block_) return;
  ensure_sums();
  totals().make_levels(tree_.discs.size(), last_block_);
  snapshot_.earlier.emplace(totals(), options.memory);
}

PhotonSums* DiscResults::photons_of(std::size_t place, std::size_t band) {
  if (photons_.empty()) return nullptr;
  return band == 0 ? &photons_[place] : &further_.photons[place * units_.size() + band - 1];
}

/// The sums of the block of photons under way.
DiscTotals DiscResults::sums_of(std::size_t place, std::size_t band) const {
  if (band == 0) return sums_[place];
  const std::size_t bands = units_.size();
  const double* const x = &further_.sums[place * classes * bands + band - 1];
  return {sums_[place].hits, {x[0], x[bands], x[2 * bands]}};
}

void DiscResults::set_power(std::size_t place, std::size_t band, const glm::dvec3& power) {
  if (band == 0) {
    sums_[place].power = power;
    return;
  }
  const std::size_t bands = units_.size();
  double* const x = &further_.sums[place * classes * bands + band - 1];
  x[0] = power.x;
  x[bands] = power.y;
  x[2 * bands] = power.z;
}

void DiscResults::ensure_sums() {
  if (!sums_.empty()) return;
  sums_.resize(tree_.discs.size());
  if (totals().keeps_errors()) photons_.resize(tree_.discs.size());
  further_.sums.resize(units_.size() * classes * sums_.size());
  further_.photons.resize(units_.size() * photons_.size());
  if (options_.totals == nullptr) return;
  if (totals().empty()) totals().resize(tree_.discs.size());
  for_each_place(
      sums_.size(), problem_.bands(),
      [&](std::size_t place, std::size_t band) {
        hwy::Prefetch(&totals().band(band)[tree_.order[place]]);
        if (!photons_.empty()) hwy::Prefetch(&totals().band(band).photon_sums(tree_.order[place]));
      },
      [&](std::size_t place, std::size_t band) {
        const Totals& all = totals().band(band);
        const DiscTotals& sums = all[tree_.order[place]];
        if (band == 0) sums_[place].hits = sums.hits;
        set_power(place, band, sums.power);
        if (!photons_.empty()) *photons_of(place, band) = all.photon_sums(tree_.order[place]);
      });
}

/// Moves the sums of earlier blocks of photons into the totals.
void DiscResults::begin_photons(std::size_t first_ray) {
  const std::uint64_t before = totals().block();
  const std::uint64_t block = photon_blocks(problem_, options_).of(problem_.photon(first_ray, first_photon_));
  if (block == before) return;
  add_counted_hits();
  for_each_place(
      sums_.size(), problem_.bands(),
      [&](std::size_t place, std::size_t band) { totals().band(band).prefetch(tree_.order[place], before); },
      [&](std::size_t place, std::size_t band) {
        DiscTotals sums = sums_of(place, band);
        totals().band(band).fold(tree_.order[place], before, block, sums, photons_of(place, band));
        set_power(place, band, sums.power);
      });
  totals().begin_block(block);
}

BlockSearch DiscResults::begin(const Frame& frame, const Block& rays) {
  const std::size_t first_ray = rays.first();
  begin_photons(first_ray);
  const bool errors = totals().keeps_errors();
  const bool one_power = rays.traits().power && (units_.empty() || problem_.one_power());
  const bool only_count = one_power && !options_.pairs && !problem_.front_facing() && !(errors && problem_.numbered());
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
          .unit = totals().unit(),
          .further = {.bands = units_.size(),
                      .powers = rays.further_powers(),
                      .sums = further_.sums.data(),
                      .photons = further_.photons.data(),
                      .units = units_.data()}};
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
  for (std::size_t band = 0; counted_power_ && band <= units_.size(); ++band) add_counted_powers(first, last, band);
  std::uint64_t found = 0;
  for (std::size_t place = first; place < last; ++place) {
    const auto [x, y, z] = std::exchange(hits_[place], {});
    const std::uint64_t added = std::uint64_t{x} + y + z;
    sums_[place].hits += added;
    found += added;
  }
  return found;
}

void DiscResults::add_counted_powers(std::size_t first, std::size_t last, std::size_t band) {
  const double power = counted_power(band);
  const double scaled = totals().band(band).unit() * power;
  RepeatedSums sums(power, options_.memory);
  RepeatedSums squares(scaled * scaled, options_.memory);
  for (std::size_t place = first; place < last; ++place) {
    const ClassCounts& hits = hits_[place];
    PhotonSums* const photons = photons_of(place, band);
    glm::dvec3 sum = sums_of(place, band).power;
    std::uint32_t added = 0;
    for (int k = 0; k < classes; ++k) {
      const std::uint32_t count = hits[static_cast<std::size_t>(k)];
      sum[k] = sums.add(sum[k], count);
      if (photons != nullptr) photons->squares[k] = squares.add(photons->squares[k], count);
      added += count;
    }
    set_power(place, band, sum);
    if (photons == nullptr || added == 0) continue;
    photons->largest = std::max(photons->largest, power);
    photons->add_photons(added);
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
  const auto further = [](const FurtherBands& bands) { return bytes_of(bands.sums) + bytes_of(bands.photons); };
  const double copy = bytes_of(hits_) + bytes_of(sums_) + bytes_of(photons_) + further(further_);
  const double more = copy - bytes_of(snapshot_.counts) - bytes_of(snapshot_.sums) - bytes_of(snapshot_.photons) -
                      further(snapshot_.further);
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
  snapshot_.further = further_;
  if (snapshot_.earlier) *snapshot_.earlier = totals();
  snapshot_.counts = hits_;
  snapshot_.counted_power = counted_power_;
  snapshot_.in_totals = found_;
}

void DiscResults::restore_snapshot() {
  rays_ = snapshot_.rays;
  sums_ = std::move(snapshot_.sums);
  photons_ = std::move(snapshot_.photons);
  further_ = std::move(snapshot_.further);
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
  if (outcome_.stopped) outcome_.clear_errors();
  if (by_discs_) mark_done_discs(skipped);
}

/// Fills in the outcome without totals, from counts of hits of equal power.
void DiscResults::store_counted() const {
  resize_results(hits_.size(), false, outcome_, problem_.bands());
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
  for (std::size_t band = 1; band < problem_.bands(); ++band) store_counted(first, last, band);
  return found;
}

/// The same in a further band.
void DiscResults::store_counted(std::size_t first, std::size_t last, std::size_t band) const {
  RepeatedSums sums(counted_power(band), options_.memory);
  for (std::size_t place = first; place < last; ++place) {
    const auto& [x, y, z] = hits_[place];
    const std::uint32_t disc = tree_.order[place];
    const FoundSums found{0, (sums.add(0, x) + sums.add(0, y)) + sums.add(0, z), problem_.discs()[disc].radius};
    outcome_.further[band - 1].irradiance[disc] = result_of(found, nullptr, 0, 0, problem_.scale()).irradiance;
  }
}

/// What finish_disc would store in further bands of discs first … last - 1, without standard errors and earlier blocks of photons.
void DiscResults::store_further_sums(std::span<const std::uint32_t> place_of, std::size_t first,
                                     std::size_t last) const {
  const std::size_t bands = units_.size();
  std::array<double, 8> areas{};
  for (std::size_t disc = first; disc < last; ++disc) {
    const double radius = problem_.discs()[disc].radius;
    areas[disc - first] = std::numbers::pi * radius * radius / own_.scale();
  }
  for (std::size_t band = 0; band < bands; ++band) {
    double* const irradiance = outcome_.further[band].irradiance.data();
    for (std::size_t disc = first; disc < last; ++disc) {
      const double* const x = &further_.sums[place_of[disc] * classes * bands + band];
      irradiance[disc] = ((x[0] + x[bands]) + x[2 * bands]) / areas[disc - first];
    }
  }
}

void DiscResults::store_totals() {
  add_counted_hits();
  outcome_.total_hits = found_;
  totals().add_rays(problem_);
  const bool own = options_.totals == nullptr;
  if (own) resize_results(sums_.size(), !photons_.empty(), outcome_, problem_.bands());
  std::pmr::vector<double> heaviest(options_.memory);
  for (std::size_t band = 0; band < problem_.bands(); ++band) heaviest.push_back(problem_.largest_power(band));
  for (std::size_t place = 0; place < photons_.size(); ++place)
    for (std::size_t band = 0; band < problem_.bands(); ++band) {
      PhotonSums& photons = *photons_of(place, band);
      photons.close(band == 0 ? totals().unit() : units_[band - 1]);
      heaviest[band] = std::max(heaviest[band], photons.largest);
    }
  // Where nothing hits, the outcome's results are 0 already.
  const auto is_zero = [&](std::size_t place) { return photons_.empty() && sums_[place].hits == 0; };
  const auto fetch = [&](std::size_t place, std::size_t) {
    const std::uint32_t disc = tree_.order[place];
    if (!own) {
      hwy::Prefetch(&totals()[disc]);
      return;
    }
    if (is_zero(place)) return;
    hwy::Prefetch(&problem_.discs()[disc].radius);
    hwy::Prefetch(&outcome_.hits[disc]);
    hwy::Prefetch(&outcome_.irradiance[disc]);
  };
  const auto store = [&](std::size_t place, std::size_t band) {
    const std::uint32_t disc = tree_.order[place];
    if (own && is_zero(place)) return;
    const DiscTotals sums = sums_of(place, band);
    const PhotonSums* const photons = photons_of(place, band);
    Totals& all = totals().band(band);
    if (own) {
      if (band == 0) outcome_.hits[disc] = sums.hits;
      finish_disc(all, problem_.discs()[disc], disc, sums, photons, heaviest[band], outcome_.band(band));
    } else {
      all[disc] = sums;
      if (photons != nullptr) all.photon_sums(disc) = *photons;
    }
  };
  if (units_.empty()) return for_each_place(sums_.size(), 1, fetch, store);
  // With rows of several bands, in the order of the discs: a row is read whole, and the arrays of all bands are written one line after another.
  std::pmr::vector<std::uint32_t> place_of(sums_.size(), options_.memory);
  for (std::size_t place = 0; place < sums_.size(); ++place)
    place_of[tree_.order[place]] = static_cast<std::uint32_t>(place);
  const bool sums_alone = own && photons_.empty() && totals().block() == 0;
  constexpr std::size_t rows_in_cache = 8;
  constexpr std::size_t in_line = 64 / sizeof(double);
  const std::size_t row = classes * units_.size();
  sim::parallel_for(ParallelRange(0, sums_.size(), std::size_t{1} << 12), [&](const ParallelRange& part) {
    for (std::size_t first = part.begin(); first < part.end(); first += rows_in_cache) {
      for (std::size_t disc = first + rows_in_cache; disc < std::min(part.end(), first + 2 * rows_in_cache); ++disc) {
        for (std::size_t band = 0; band < row; band += in_line)
          hwy::Prefetch(&further_.sums[place_of[disc] * row + band]);
        for (std::size_t band = 0; !photons_.empty() && band < units_.size(); ++band)
          hwy::Prefetch(&further_.photons[place_of[disc] * units_.size() + band]);
      }
      const std::size_t end = std::min(part.end(), first + rows_in_cache);
      const std::size_t bands = sums_alone ? 1 : problem_.bands();
      for (std::size_t band = 0; band < bands; ++band)
        for (std::size_t disc = first; disc < end; ++disc) store(place_of[disc], band);
      if (sums_alone) store_further_sums(place_of, first, end);
    }
  });
}

}  // namespace detp::sim::stream
