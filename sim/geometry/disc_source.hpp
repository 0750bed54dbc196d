#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "geometry.hpp"

/// Sources that return discs by number, so that only a part of them needs to be in memory at a time.
namespace detp::sim {

/// A sequence of discs. Every read of a disc returns the same bytes.
class DiscSource {
 public:
  virtual ~DiscSource() = default;

  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Fills the block with the discs first, first + 1, …. Callers must not read beyond the last disc. Throws Stopped if a stop was
  /// requested; the block's contents are then unspecified.
  virtual void read(std::uint64_t first, std::span<Disc> block, const std::stop_token& stop = {}) const = 0;
  /// All discs, if they are in memory; else empty.
  [[nodiscard]] virtual std::span<const Disc> in_memory() const { return {}; }
};

/// Discs in memory. They are not copied, and must outlive the source. read() does not check for a stop request.
class DiscsInMemory final : public DiscSource {
 public:
  explicit DiscsInMemory(std::span<const Disc> discs) : discs_(discs) {}

  [[nodiscard]] std::uint64_t size() const override { return discs_.size(); }
  void read(std::uint64_t first, std::span<Disc> block, const std::stop_token&) const override {
    std::copy_n(discs_.begin() + static_cast<std::ptrdiff_t>(first), block.size(), block.begin());
  }
  [[nodiscard]] std::span<const Disc> in_memory() const override { return discs_; }

 private:
  std::span<const Disc> discs_;
};

/// Calls visit(number of the first, discs) for all discs in their order, some at a time. Throws as DiscSource::read.
template <class Visit>
void for_each_block(const DiscSource& source, const std::stop_token& stop, const Visit& visit) {
  constexpr std::uint64_t at_once = 1 << 16;
  std::vector<Disc> block;
  for (std::uint64_t first = 0; first < source.size(); first += block.size()) {
    block.resize(static_cast<std::size_t>(std::min(at_once, source.size() - first)));
    source.read(first, block, stop);
    visit(first, std::span<const Disc>(block));
  }
}

}  // namespace detp::sim
