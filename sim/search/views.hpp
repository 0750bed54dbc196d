#pragma once

#include <cstddef>
#include <cstring>
#include <glm/vec3.hpp>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

/// Rays and discs in a caller's arrays: floats or doubles, with any stride.
namespace detp::sim {

/// A caller's array, not copied. Each element has `components` numbers.
template <int components>
class ArrayView {
 public:
  /// `stride` is the number of bytes from one element to the next.
  ArrayView(const float* first, std::size_t stride = components * sizeof(float))
      : first_(reinterpret_cast<const std::byte*>(first)), stride_(stride), floats_(true) {}
  ArrayView(const double* first, std::size_t stride = components * sizeof(double))
      : first_(reinterpret_cast<const std::byte*>(first)), stride_(stride) {}

  /// Number k of element i.
  [[nodiscard]] double at(std::size_t i, int k) const {
    const std::byte* const place = first_ + i * stride_;
    return floats_ ? value<float>(place, k) : value<double>(place, k);
  }

 private:
  template <class T>
  [[nodiscard]] static double value(const std::byte* place, int k) {
    T value;  // copied, because the caller's structs may be packed
    std::memcpy(&value, place + static_cast<std::size_t>(k) * sizeof(T), sizeof(T));
    return static_cast<double>(value);
  }

  const std::byte* first_;
  std::size_t stride_;
  bool floats_ = false;
};

/// Elements of three numbers: points or directions.
using VectorsView = ArrayView<3>;

/// One number for each element, or the same number for all.
class NumbersView : public ArrayView<1> {
 public:
  using ArrayView::ArrayView;
  NumbersView(double of_all) : ArrayView(static_cast<const double*>(nullptr)), of_all_(of_all), same_(true) {}

  [[nodiscard]] double operator[](std::size_t i) const { return same_ ? of_all_ : at(i, 0); }

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
};

/// Discs: see Disc for the meaning of each field. Normals may have any length except 0.
struct DiscsView {
  std::size_t count = 0;
  VectorsView centres;
  VectorsView normals;
  NumbersView radii;
};

/// Copies the rays and normalises their directions. A direction of 0 stays 0; a direction that is not finite stays so.
void read_rays(const RaysView& view, std::vector<Ray>& rays);

/// Copies the discs and normalises their normals, as read_rays does.
[[nodiscard]] std::vector<Disc> read_discs(const DiscsView& view);

}  // namespace detp::sim
