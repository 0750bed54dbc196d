#pragma once

#include "detp/sim/geometry/disc_source.hpp"

namespace detp::support {

/// Discs that are read, as those of a file are.
class DiscsElsewhere final : public sim::DiscSource {
 public:
  explicit DiscsElsewhere(std::span<const sim::Disc> discs) : discs_(discs) {}
  [[nodiscard]] std::uint64_t size() const override { return discs_.size(); }
  void read(std::uint64_t first, std::span<sim::Disc> block, const std::stop_token& stop) const override {
    discs_.read(first, block, stop);
  }

 private:
  sim::DiscsInMemory discs_;
};

}  // namespace detp::support
