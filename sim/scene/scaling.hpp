#pragma once

#include <cmath>
#include <cstdlib>
#include <glm/vec3.hpp>

namespace detp::sim {

/// Multiplies points by a power of two, which is exact. Areas of what is scaled to about 1 neither vanish nor overflow.
class Scaling {
 public:
  explicit Scaling(int exponent = 0)
      : exponent_(exponent), factor_(std::abs(exponent) < 1000 ? std::ldexp(1.0, exponent) : 0) {}
  /// That which scales a coordinate of this size to at least 1 and less than 2; none for 0.
  static Scaling to_one(double size) { return Scaling(size > 0 ? -std::ilogb(size) : 0); }

  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& point) const {
    if (factor_ > 0) return factor_ * point;
    return {std::scalbn(point.x, exponent_), std::scalbn(point.y, exponent_), std::scalbn(point.z, exponent_)};
  }
  [[nodiscard]] Scaling inverse() const { return Scaling(-exponent_); }

 private:
  int exponent_;
  double factor_;  ///< 0: perhaps beyond the range of doubles
};

}  // namespace detp::sim
