#include "totals.hpp"

#include <algorithm>
#include <bit>

#include "problem.hpp"

namespace detp::sim {
namespace {

double sum_of(const glm::dvec3& by_axis) { return (by_axis.x + by_axis.y) + by_axis.z; }

}  // namespace

Totals::Totals(std::size_t discs, Memory* memory) : discs_(discs, memory), photon_sums_(memory), levels_(memory) {}

Totals::Totals(const Totals& other, Memory* memory)
    : discs_(other.discs_, memory),
      photon_sums_(other.photon_sums_, memory),
      levels_(memory),
      keeps_errors_(other.keeps_errors_),
      block_(other.block_),
      rays_(other.rays_),
      photons_(other.photons_),
      largest_power_(other.largest_power_) {
  for (const Level& level : other.levels_)
    levels_.push_back({std::pmr::vector<double>(level.power, memory), std::pmr::vector<double>(level.squares, memory)});
}

void Totals::resize(std::size_t discs) {
  discs_.resize(discs);
  if (keeps_errors_) photon_sums_.resize(discs);
}

void Totals::keep_errors() {
  keeps_errors_ = true;
  photon_sums_.resize(discs_.size());
}

void Totals::make_levels(std::size_t discs, std::uint64_t last_block) {
  std::pmr::memory_resource* const memory = levels_.get_allocator().resource();
  while (levels_.size() < static_cast<std::size_t>(std::bit_width(last_block)))
    levels_.push_back(
        {std::pmr::vector<double>(discs, memory), std::pmr::vector<double>(keeps_errors_ ? discs : 0, memory)});
}

/// Adds T(level, i), which begins at block `number`, to the counter.
void Totals::add_subtree(Sums sums, std::size_t disc, std::uint64_t number, std::size_t level, double sum) {
  for (; (number >> level & 1) != 0; ++level) sum = (levels_[level].*sums)[disc] + sum;
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
  photons->close();
  add_blocks(&Level::squares, disc, from, to, sum_of(photons->squares));
  photons->squares = glm::dvec3{0.0};
}

double Totals::power(std::size_t disc, const DiscTotals& sums) const {
  return total(&Level::power, disc, sum_of(sums.power));
}

double Totals::squares(std::size_t disc, const PhotonSums& sums) const {
  return total(&Level::squares, disc, sum_of(sums.squares));
}

void Totals::add_rays(const Problem& problem) {
  photons_ = problem.numbered() ? std::max(photons_, problem.photons_to()) : photons_ + problem.rays().size();
  rays_ += problem.rays().size();
  largest_power_ = std::max(largest_power_, problem.largest_power());
}

}  // namespace detp::sim
