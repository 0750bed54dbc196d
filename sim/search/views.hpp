#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/vec3.hpp>
#include <span>
#include <type_traits>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

/// Rays and discs in a caller's arrays: floats or doubles, with any stride.
namespace detp::sim {

/// A caller's array, not copied. Each element has `components` numbers.
template <int components>
class ArrayView {
 public:
  /// Elements one after another; `stride` is the number of bytes from one element to the next.
  ArrayView(const float* first, std::size_t stride = components * sizeof(float)) : ArrayView(stride, first) {}
  ArrayView(const double* first, std::size_t stride = components * sizeof(double)) : ArrayView(stride, first) {}

  /// Number k of element i.
  [[nodiscard]] double at(std::size_t i, int k) const { return floats_ ? get<float>(i, k) : get<double>(i, k); }
  /// The same if the type is known: float or double.
  template <class T>
  [[nodiscard]] double get(std::size_t i, int k) const {
    T value;  // copied, because the caller's structs may be packed
    std::memcpy(&value, first_[static_cast<std::size_t>(k)] + i * stride_, sizeof(T));
    return static_cast<double>(value);
  }

  [[nodiscard]] bool floats() const { return floats_; }
  /// True if there is an array for each component.
  [[nodiscard]] bool exists() const {
    return std::ranges::none_of(first_, [](const std::byte* first) { return first == nullptr; });
  }

 protected:
  /// An array for each component.
  template <class T>
  ArrayView(std::size_t stride, const std::array<const T*, components>& arrays)
      : stride_(stride), floats_(std::is_same_v<T, float>) {
    for (std::size_t k = 0; k < components; ++k) first_[k] = reinterpret_cast<const std::byte*>(arrays[k]);
  }

 private:
  template <class T>
  ArrayView(std::size_t stride, const T* first) : stride_(stride), floats_(std::is_same_v<T, float>) {
    for (std::size_t k = 0; first != nullptr && k < components; ++k)
      first_[k] = reinterpret_cast<const std::byte*>(first + k);
  }

  std::array<const std::byte*, components> first_{};  ///< of each component
  std::size_t stride_;
  bool floats_;
};

/// Elements of three numbers: points or directions.
class VectorsView : public ArrayView<3> {
 public:
  using ArrayView::ArrayView;
  /// The coordinates in arrays of their own.
  VectorsView(const float* x, const float* y, const float* z, std::size_t stride = sizeof(float))
      : ArrayView(stride, std::array{x, y, z}) {}
  VectorsView(const double* x, const double* y, const double* z, std::size_t stride = sizeof(double))
      : ArrayView(stride, std::array{x, y, z}) {}
};

/// One number for each element, or the same number for all.
class NumbersView : public ArrayView<1> {
 public:
  using ArrayView::ArrayView;
  NumbersView(double of_all) : ArrayView(static_cast<const double*>(nullptr)), of_all_(of_all), same_(true) {}

  [[nodiscard]] double operator[](std::size_t i) const { return same_ ? of_all_ : at(i, 0); }
  [[nodiscard]] bool exists() const { return same_ || ArrayView::exists(); }

 private:
  double of_all_ = 0;
  bool same_ = false;
};

/// Rays: see Ray for the meaning of each field. Directions may have any length except 0.
struct RaysView {
  std::size_t count = 0;
  VectorsView origins;
  VectorsView directions;
  NumbersView lengths = unbounded;
  NumbersView powers = 1.0;
  std::span<const std::uint64_t> photons = {};   ///< as PathRays::photons; not copied
  std::span<const double> landings = {};         ///< as PathRays::landings; not copied
  std::vector<NumbersView> further_powers = {};  ///< in bands 1, 2, …; band 0 has `powers`

  /// Powers in bands from an array of rows: a row of `bands` numbers for each ray, `stride` bytes after the one before (0: without gaps).
  template <class T>
  void set_powers(const T* rows, std::size_t bands, std::size_t stride = 0) {
    if (stride == 0) stride = bands * sizeof(T);
    powers = NumbersView(rows, stride);
    further_powers.clear();
    for (std::size_t band = 1; band < bands; ++band)
      further_powers.emplace_back(rows == nullptr ? nullptr : rows + band, stride);
  }
};

/// Discs: see Disc for the meaning of each field. Normals may have any length except 0.
struct DiscsView {
  std::size_t count = 0;
  VectorsView centres;
  VectorsView normals;
  NumbersView radii;
};

/// Copies the rays first … first + rays.size() - 1 on so many threads (as RunOptions::threads), and normalises their
/// directions. A direction of 0 stays 0; a direction that is not finite stays so. Throws std::invalid_argument if an array is
/// null, or if threads are out of range.
void read_rays(const RaysView& view, std::size_t first, std::span<Ray> rays, int threads = 1);

/// Copies to `powers` the further powers of the rays first … first + rays - 1: a row for each (FurtherPowers). Throws as read_rays.
void read_further_powers(const RaysView& view, std::size_t first, std::size_t rays, std::vector<double>& powers);

/// One ray.
[[nodiscard]] Ray read_ray(const RaysView& view, std::size_t number);

/// `photons`, if any, has a number for each ray. The largest end of a piece of the rays that begins at ray `first`, has at most `most` rays, and does not split a photon; if
/// the first photon alone has more rays, the end of that photon.
[[nodiscard]] std::size_t end_of_piece(const RaysView& view, std::size_t first, std::size_t most);

/// Copies the discs and normalises their normals, as read_rays does. Throws std::length_error if they would not fit in memory.
[[nodiscard]] std::vector<Disc> read_discs(const DiscsView& view);

}  // namespace detp::sim
