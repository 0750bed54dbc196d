#include "totals.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "problem.hpp"

namespace detp::sim {
namespace {

double sum_of(const glm::dvec3& by_axis) { return (by_axis.x + by_axis.y) + by_axis.z; }

glm::dvec3 scaled(const glm::dvec3& squares, int exponent) {
  return {std::ldexp(squares.x, exponent), std::ldexp(squares.y, exponent), std::ldexp(squares.z, exponent)};
}

}  // namespace

Totals::Totals(std::size_t discs, Memory* memory)
    : discs_(discs, memory), photon_sums_(memory), levels_(memory), left_(memory) {}

Totals::Totals(const Totals& other, Memory* memory)
    : discs_(other.discs_, memory),
      photon_sums_(other.photon_sums_, memory),
      levels_(memory),
      left_(memory),
      keeps_errors_(other.keeps_errors_),
      blocks_(other.blocks_),
      origin_(other.origin_),
      block_(other.block_),
      rays_(other.rays_),
      photons_(other.photons_),
      largest_power_(other.largest_power_),
      scale_(other.scale_),
      unit_exponent_(other.unit_exponent_) {
  for (const Totals& further : other.further_) further_.emplace_back(further, memory);
  const auto copy = [&](const std::pmr::vector<Level>& from, std::pmr::vector<Level>& to) {
    for (const Level& level : from)
      to.push_back({std::pmr::vector<double>(level.power, memory), std::pmr::vector<double>(level.squares, memory)});
  };
  copy(other.levels_, levels_);
  copy(other.left_, left_);
}

void Totals::resize(std::size_t discs) {
  discs_.resize(discs);
  if (keeps_errors_) photon_sums_.resize(discs);
  for (Totals& further : further_) further.resize(discs);
}

void Totals::keep_errors() {
  keeps_errors_ = true;
  photon_sums_.resize(discs_.size());
  for (Totals& further : further_) further.keep_errors();
}

void Totals::set_bands(std::size_t bands) {
  if (bands == this->bands()) return;
  further_.clear();
  const Totals none(*this, levels_.get_allocator().resource());
  while (this->bands() < bands) further_.emplace_back(none, levels_.get_allocator().resource());
}

void Totals::expect_powers(const Problem& problem) {
  if (photons_ == 0) set_bands(problem.bands());
  if (bands() != problem.bands())
    throw std::invalid_argument(fmt::format("rays have {} bands, but earlier ones {}", problem.bands(), bands()));
  for (std::size_t band = 0; band < bands(); ++band) this->band(band).expect_power(problem.largest_power(band));
}

void Totals::expect_power(double largest_power) {
  const int exponent = sim::unit_exponent(std::max(largest_power, largest_power_));
  const int change = 2 * (exponent - std::exchange(unit_exponent_, exponent));
  if (change == 0) return;
  for (PhotonSums& sums : photon_sums_) sums.squares = scaled(sums.squares, change);
  for (std::pmr::vector<Level>* const levels : {&levels_, &left_})
    for (Level& level : *levels)
      for (double& sum : level.squares) sum = std::ldexp(sum, change);
}

void Totals::make_levels(std::size_t discs, std::uint64_t last_block) {
  std::pmr::memory_resource* const memory = levels_.get_allocator().resource();
  const auto count = static_cast<std::size_t>(std::bit_width(last_block));
  const auto add = [&](std::pmr::vector<Level>& to, std::size_t level_discs) {
    to.push_back({std::pmr::vector<double>(level_discs, memory),
                  std::pmr::vector<double>(keeps_errors_ ? level_discs : 0, memory)});
  };
  while (levels_.size() < count) add(levels_, discs);
  for (std::uint64_t start = origin_, level = 0; start != 0 && left_.size() < count; ++level) {
    const bool used = (start >> level & 1) != 0;  // by a subtree whose left neighbour is not here
    if (level == left_.size()) add(left_, used ? discs : 0);
    if (used) start += std::uint64_t{1} << level;
  }
  for (Totals& further : further_) further.make_levels(discs, last_block);
}

/// Adds T(level, i), which begins at block `number`, to the counter.
void Totals::add_subtree(Sums sums, std::size_t disc, std::uint64_t number, std::size_t level, double sum) {
  for (; (number >> level & 1) != 0; ++level) {
    if (((number >> level) - 1) << level < origin_) {
      (left_[level].*sums)[disc] = sum;
      return;
    }
    sum = (levels_[level].*sums)[disc] + sum;
  }
  (levels_[level].*sums)[disc] = sum;
}

/// Adds the blocks from … to - 1, of which all but the first are empty: these in the largest subtrees that fit.
void Totals::add_blocks(Sums sums, std::size_t disc, std::uint64_t from, std::uint64_t to, double sum_of_first) {
  add_subtree(sums, disc, from, 0, sum_of_first);
  for (std::uint64_t next = from + 1; next < to;) {
    int level = std::countr_zero(next);
    while (next + (std::uint64_t{1} << level) > to) --level;
    add_subtree(sums, disc, next, static_cast<std::size_t>(level), 0);
    next += std::uint64_t{1} << level;
  }
}

double Totals::total(Sums sums, std::size_t disc, double block_under_way) const {
  for (std::size_t level = 0; level < levels_.size(); ++level)
    if ((block_ >> level & 1) != 0) block_under_way = (levels_[level].*sums)[disc] + block_under_way;
  return block_under_way;
}

void Totals::fold(std::size_t disc, std::uint64_t from, std::uint64_t to, DiscTotals& sums, PhotonSums* photons) {
  if (from >= to) return;
  add_blocks(&Level::power, disc, from, to, sum_of(sums.power));
  sums.power = glm::dvec3{0.0};
  if (photons == nullptr) return;
  photons->close(unit());
  add_blocks(&Level::squares, disc, from, to, sum_of(photons->squares));
  photons->squares = glm::dvec3{0.0};
}

void Totals::prefetch(std::size_t disc, std::uint64_t from) const {
  const std::size_t used = std::min(levels_.size(), static_cast<std::size_t>(std::countr_one(from)) + 1);
  for (std::size_t level = 0; level < used; ++level) {
    __builtin_prefetch(&levels_[level].power[disc], 1);
    if (keeps_errors_) __builtin_prefetch(&levels_[level].squares[disc], 1);
  }
}

void Totals::begin_at(std::uint64_t block) {
  origin_ = block_ = block;
  rays_ = photon_blocks().first(block);  // if rays are photons
  for (Totals& further : further_) further.begin_at(block);
}

void Totals::complete(std::uint64_t block) {
  make_levels(discs_.size(), block);
  for (Totals& further : further_) further.complete(block);
  for (std::size_t disc = 0; disc < discs_.size(); ++disc)
    fold(disc, block_, block, discs_[disc], keeps_errors_ ? &photon_sums_[disc] : nullptr);
  begin_block(std::max(block, block_));
}

std::vector<Totals::Subtree> Totals::subtrees() const {
  std::vector<Subtree> found;
  std::uint64_t start = origin_;
  while (start != 0 && start + (start & -start) <= block_) {
    found.push_back({start, static_cast<std::size_t>(std::countr_zero(start)), true});
    start += start & -start;
  }
  for (std::size_t level = static_cast<std::size_t>(std::bit_width(block_)); level-- > 0;)
    if ((block_ >> level & 1) != 0 && ((block_ >> level) - 1) << level >= start)
      found.push_back({((block_ >> level) - 1) << level, level, false});
  return found;
}

Totals::Shape Totals::shape() const {
  return {discs_.size(),  origin_,        block_,         rays_, photons_, keeps_errors_ ? std::uint64_t{1} : 0,
          largest_power_, unit_exponent_, photon_blocks()};
}

Totals Totals::of_shape(const Shape& shape) {
  Totals made;
  made.origin_ = shape.origin;
  made.block_ = shape.block;
  made.rays_ = shape.rays;
  made.photons_ = shape.photons;
  made.largest_power_ = shape.largest_power;
  made.unit_exponent_ = shape.unit_exponent;
  made.keeps_errors_ = shape.errors != 0;
  made.blocks_ = shape.blocks;
  made.resize(shape.discs);
  made.make_levels(shape.discs, shape.block);
  return made;
}

void Totals::append(const Totals& later) {
  if (later.bands() != bands()) throw std::invalid_argument("sums of photons have other numbers of bands");
  for (std::size_t band = 0; band < bands(); ++band) this->band(band).append_band(later.band(band));
}

void Totals::append_band(const Totals& later) {
  if (later.origin_ != block_ || later.discs_.size() != discs_.size() || later.keeps_errors_ != keeps_errors_ ||
      later.photon_blocks() != photon_blocks())
    throw std::invalid_argument("sums of photons do not follow one another");
  make_levels(discs_.size(), later.block_);
  expect_power(later.largest_power_);
  const int change = 2 * (unit_exponent_ - later.unit_exponent_);
  for (const Subtree& subtree : later.subtrees()) {
    const Level& from = (subtree.left ? later.left_ : later.levels_)[subtree.level];
    for (std::size_t disc = 0; disc < discs_.size(); ++disc)
      add_subtree(&Level::power, disc, subtree.start, subtree.level, from.power[disc]);
    for (std::size_t disc = 0; disc < from.squares.size(); ++disc)
      add_subtree(&Level::squares, disc, subtree.start, subtree.level, std::ldexp(from.squares[disc], change));
  }
  for (std::size_t disc = 0; disc < discs_.size(); ++disc) {
    discs_[disc].hits += later.discs_[disc].hits;
    discs_[disc].power = later.discs_[disc].power;
  }
  for (std::size_t disc = 0; disc < photon_sums_.size(); ++disc) {
    PhotonSums& sums = photon_sums_[disc];
    const PhotonSums& more = later.photon_sums_[disc];
    sums.close(unit());
    sums.squares = scaled(more.squares, change);
    sums.largest = std::max(sums.largest, more.largest);
    sums.add_photons(more.photons);
  }
  block_ = later.block_;
  rays_ = later.rays_;
  photons_ = std::max(photons_, later.photons_);
  largest_power_ = std::max(largest_power_, later.largest_power_);
}

double Totals::power(std::size_t disc, const DiscTotals& sums) const {
  return total(&Level::power, disc, sum_of(sums.power));
}

double Totals::squares(std::size_t disc, const PhotonSums& sums) const {
  return total(&Level::squares, disc, sum_of(sums.squares));
}

void Totals::add_rays(const Problem& problem) {
  rays_ += problem.rays().size();
  photons_ = std::max(photons_, problem.numbered() ? problem.photons_to() : rays_);
  scale_ = problem.scale();
  for (std::size_t band = 0; band < bands(); ++band) {
    Totals& sums = this->band(band);
    sums.rays_ = rays_;
    sums.photons_ = photons_;
    sums.scale_ = scale_;
    sums.largest_power_ = std::max(sums.largest_power_, problem.largest_power(band));
  }
}

}  // namespace detp::sim
