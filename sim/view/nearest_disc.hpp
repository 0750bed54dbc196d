#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Which disc stands for a place of a surface between the discs.
class NearestDisc {
 public:
  static constexpr double reach = 3;  ///< radii of a disc

  /// The discs must stay. Throws Stopped.
  explicit NearestDisc(std::span<const Disc> discs, const std::stop_token& stop = {});
  ~NearestDisc();
  NearestDisc(const NearestDisc&) = delete;
  NearestDisc& operator=(const NearestDisc&) = delete;

  /// Of the 16 nearest discs the nearest one that has the place within its reach, and whose normal or its opposite is within 60 degrees of
  /// the surface's; nothing if there is none. Safe to use from many threads.
  [[nodiscard]] std::optional<std::uint32_t> at(const glm::dvec3& place, const glm::dvec3& normal) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace detp::sim
