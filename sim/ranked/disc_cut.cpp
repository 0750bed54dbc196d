#include "disc_cut.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/geometry/curve.hpp"

namespace detp::sim {
namespace {

/// On the curve.
bool before(const KeyedIndex& a, const KeyedIndex& b) { return a.key != b.key ? a.key < b.key : a.index < b.index; }

}  // namespace

DiscCut::DiscCut(const DiscSource& discs, std::size_t parts, const std::stop_token& stop)
    : stride_((discs.size() + most_sampled - 1) / most_sampled), cuts_(parts + 1) {
  if (discs.size() < parts) throw std::invalid_argument("there are more parts than discs to share");
  double squares = 0;
  for_each_block(discs, stop, [&](std::uint64_t, std::span<const Disc> block) {
    for (const Disc& disc : block) {
      centres_.include(disc.centre);
      squares += disc.radius * disc.radius;
    }
  });
  if (discs.size() / stride_ < parts) stride_ = 1;
  const double mean = squares / static_cast<double>(discs.size());
  std::vector<float> costs;  // in the discs' order
  for_each_block(discs, stop, [&](std::uint64_t first, std::span<const Disc> block) {
    for (std::uint64_t i = (stride_ - first % stride_) % stride_; i < block.size(); i += stride_) {
      const Disc& disc = block[i];
      sampled_.push_back({lebesgue_code(disc.centre, centres_), static_cast<std::uint32_t>(first + i)});
      costs.push_back(static_cast<float>(1 + disc.radius * disc.radius / mean));
    }
  });
  std::ranges::sort(sampled_, before);
  for (const KeyedIndex& one : sampled_) costs_.push_back(costs[one.index / stride_]);
  cut();
}

void DiscCut::cut() {
  const double all = std::accumulate(costs_.begin(), costs_.end(), 0.0);
  const std::size_t parts = cuts_.size() - 1;
  double sum = 0;
  std::size_t next = 0;
  for (std::size_t part = 1; part < parts; ++part) {
    const double wanted = all * static_cast<double>(part) / static_cast<double>(parts);
    const std::size_t least = cuts_[part - 1] + 1;
    while (next < sampled_.size() - (parts - part) && (next < least || sum < wanted)) sum += costs_[next++];
    cuts_[part] = next;
  }
  cuts_.back() = sampled_.size();
  begins_.clear();
  for (std::size_t part = 1; part < parts; ++part) begins_.push_back(sampled_[cuts_[part]]);
}

void DiscCut::find_parts(std::span<const Disc> discs, std::uint64_t first, std::span<std::uint32_t> parts) const {
  constexpr std::size_t at_once = std::size_t{1} << 12;
  sim::parallel_for(std::size_t{0}, (discs.size() + at_once - 1) / at_once, [&](std::size_t piece) {
    for (std::size_t i = piece * at_once; i < std::min(discs.size(), (piece + 1) * at_once); ++i) {
      const KeyedIndex place{lebesgue_code(discs[i].centre, centres_), static_cast<std::uint32_t>(first + i)};
      parts[i] = static_cast<std::uint32_t>(std::ranges::upper_bound(begins_, place, before) - begins_.begin());
    }
  });
}

void DiscCut::correct(std::span<const double> seconds) {
  for (std::size_t part = 0; part < seconds.size(); ++part) {
    double cost = 0;
    for (std::size_t i = cuts_[part]; i < cuts_[part + 1]; ++i) cost += costs_[i];
    for (std::size_t i = cuts_[part]; i < cuts_[part + 1]; ++i) costs_[i] *= static_cast<float>(seconds[part] / cost);
  }
  cut();
}

}  // namespace detp::sim
