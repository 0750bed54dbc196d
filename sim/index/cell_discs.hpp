#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detp/sim/lists/simd/disc_tree.hpp"
#include "detp/sim/lists/simd/ray_list.hpp"

/// One ray against the discs of a cell, a vector of discs at a time.
namespace detp::sim {

/// Rays in floats, one after another, in the coordinates of their classes.
struct FloatRay {
  std::array<float, 4> line;             ///< a, b, p, q of RayList
  std::array<float, 2> ends;             ///< RayList::from, to
  std::uint32_t falling = 0;             ///< stream::falling if the ray goes towards smaller z
  std::uint32_t axis = stream::classes;  ///< its class; `classes`: it stays far from S₀, or has not been loaded
};

/// Loads the rays of a chunk into `loaded`.
class FloatRays {
 public:
  explicit FloatRays(std::pmr::memory_resource* memory) : arena_(memory), loaded_(memory) {}

  void load(std::span<const Ray> rays, const stream::Frame& frame);
  [[nodiscard]] const FloatRay& operator[](std::size_t i) const { return loaded_[i]; }

 private:
  stream::ListArena arena_;
  std::pmr::vector<FloatRay> loaded_;
};

/// Bit i tells about disc i of up to 64.
struct CellDecision {
  std::uint64_t sure = 0;    ///< the ray certainly hits it
  std::uint64_t unsure = 0;  ///< the ray possibly hits it: decide again in double
};

inline constexpr std::size_t most_decided = 64;  ///< discs at once

/// Decides for a ray and 1 to most_decided discs, as the kernels do for lists of rays (sim/lists/simd/floats.md): each lane has the same
/// operations, so the same bounds hold. Reads up to `padding` discs beyond the end.
using DecideCell = CellDecision (*)(const FloatRay&, const stream::FloatDisc* discs, std::size_t count);

/// For the rays of each class.
using DecideCells = std::array<DecideCell, stream::classes>;

/// The decisions for segments or whole lines, at both faces of the discs or only at their fronts.
[[nodiscard]] DecideCells decide_cells(bool segments, bool front_facing);

/// The discs of all cells in floats, in the order of the cells' references.
class CellDiscs {
 public:
  static constexpr std::size_t padding = 8;

  CellDiscs(const Problem& problem, std::span<const std::uint32_t> references, const std::stop_token& stop);

  [[nodiscard]] const stream::Frame& frame() const { return frame_; }
  [[nodiscard]] const stream::FloatDisc* discs() const { return discs_.data(); }
  [[nodiscard]] static double bytes(std::size_t references) {
    return sizeof(stream::FloatDisc) * static_cast<double>(references + padding);
  }

 private:
  stream::Frame frame_;
  UnsetVector<stream::FloatDisc> discs_;
};

}  // namespace detp::sim
