#pragma once

#include <algorithm>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "detp/sim/geometry/geometry.hpp"

/// Exact versions of the predicates. Every double is an integer times a power of 2, and each predicate is the sign of a
/// polynomial in doubles, so integers with enough bits decide it. Directions and normals are used without normalising:
/// the ray is the line that the direction spans, or the points origin + t direction, 0 <= t <= length; the normal only
/// defines the plane.
namespace detp::support {

/// Integers of up to 4096 bits on the stack; throws if a result needs more.
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    4096, 4096, boost::multiprecision::signed_magnitude, boost::multiprecision::checked, void>>;

/// number · 2^bits; also for negative numbers, for which << throws.
inline Integer shifted(Integer number, int bits) {
  const bool negative = number < 0;
  if (negative) number.backend().negate();
  number <<= bits;
  if (negative) number.backend().negate();
  return number;
}

/// mantissa · 2^exponent, with an odd mantissa or 0.
struct Dyadic {
  explicit Dyadic(double value) {
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
    exponent -= 53;
    if (mantissa == 0) return;
    const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
    mantissa /= std::int64_t{1} << zeros;
    exponent += zeros;
  }
  std::int64_t mantissa;
  int exponent;
};

/// Represents numbers as integers in units of one power of 2, the largest that divides them all.
class Units {
 public:
  Units(std::initializer_list<double> values) {
    for (const double value : values)
      if (value != 0) exponent_ = std::min(exponent_, Dyadic(value).exponent);
  }
  [[nodiscard]] int exponent() const { return exponent_; }
  [[nodiscard]] Integer operator()(double value) const {
    if (value == 0) return 0;
    const Dyadic dyadic(value);
    return shifted(dyadic.mantissa, dyadic.exponent - exponent_);
  }

 private:
  int exponent_ = 0;
};

struct Vector {
  Integer x, y, z;
};
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(const Integer& k, const Vector& a) { return {k * a.x, k * a.y, k * a.z}; }
inline Integer dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector in(const Units& units, const glm::dvec3& v) { return {units(v.x), units(v.y), units(v.z)}; }

/// number · 2^exponent, rounded.
inline double rounded(const Integer& number, int exponent) {
  if (number == 0) return 0;
  const Integer size = abs(number);
  const int excess = static_cast<int>(msb(size)) - 62;
  const Integer leading = excess > 0 ? Integer{size >> excess} : size;
  const double value =
      std::ldexp(static_cast<double>(static_cast<std::uint64_t>(leading)), std::max(excess, 0) + exponent);
  return number < 0 ? -value : value;
}

/// √a - √b without cancellation; a and b are in units of 2^(2 exponent).
inline double difference_of_roots(const Integer& a, const Integer& b, int exponent) {
  const double sum = std::sqrt(rounded(a, 2 * exponent)) + std::sqrt(rounded(b, 2 * exponent));
  return sum == 0 ? 0 : rounded(a - b, 2 * exponent) / sum;
}

/// A ray and a disc. Lengths are in units of 2^p, directions of 2^q, normals of 2^r.
class ExactDisc {
 public:
  ExactDisc(const sim::Ray& ray, const sim::Disc& disc)
      : lengths_{ray.origin.x,  ray.origin.y,  ray.origin.z, disc.centre.x,
                 disc.centre.y, disc.centre.z, disc.radius,  ray.is_line() ? 0 : ray.length},
        directions_{ray.direction.x, ray.direction.y, ray.direction.z},
        normals_{disc.normal.x, disc.normal.y, disc.normal.z},
        line_(ray.is_line()) {
    const Vector w = in(lengths_, ray.origin) - in(lengths_, disc.centre);
    const Vector direction = in(directions_, ray.direction);
    const Vector normal = in(normals_, disc.normal);
    facing_ = dot(normal, direction);
    const Integer height = dot(normal, w);
    const Vector crossing = facing_ * w - height * direction;
    crossing_ = dot(crossing, crossing);
    const Integer rim = lengths_(disc.radius) * facing_;
    rim_ = rim * rim;
    ahead_ = shifted(facing_ > 0 ? Integer{-height} : height, -directions_.exponent());
    if (!line_) end_ = lengths_(ray.length) * abs(facing_);
  }

  [[nodiscard]] bool hit() const {
    if (facing_ == 0 || crossing_ > rim_) return false;
    return line_ || (ahead_ >= 0 && ahead_ <= end_);
  }

  /// |n × (w × D)| - d |n·D|
  [[nodiscard]] double beyond_rim() const { return difference_of_roots(crossing_, rim_, exponent()); }
  /// -n·w, towards the plane
  [[nodiscard]] double ahead() const { return rounded(ahead_, exponent()); }
  /// -n·w - length |n·D|
  [[nodiscard]] double beyond_end() const { return rounded(ahead_ - end_, exponent()); }

 private:
  [[nodiscard]] int exponent() const { return lengths_.exponent() + directions_.exponent() + normals_.exponent(); }

  Units lengths_, directions_, normals_;
  bool line_;
  Integer facing_, crossing_, rim_, ahead_, end_;
};

/// A ray and a sphere.
class ExactSphere {
 public:
  ExactSphere(const sim::Ray& ray, const sim::Sphere& sphere)
      : lengths_{ray.origin.x,    ray.origin.y,    ray.origin.z,  sphere.centre.x,
                 sphere.centre.y, sphere.centre.z, sphere.radius, ray.is_line() ? 0 : ray.length},
        directions_{ray.direction.x, ray.direction.y, ray.direction.z} {
    const Vector f = in(lengths_, sphere.centre) - in(lengths_, ray.origin);
    const Vector direction = in(directions_, ray.direction);
    const Integer radius = lengths_(sphere.radius);
    const Integer along = dot(f, direction);
    const Integer square = dot(direction, direction);
    if (!ray.is_line() && along < 0) {  // the ray's origin is nearest
      distance_ = dot(f, f);
      radius_ = radius * radius;
      exponent_ = lengths_.exponent();
      return;
    }
    exponent_ = lengths_.exponent() + directions_.exponent();
    const int one = -directions_.exponent();
    if (!ray.is_line() && shifted(along, one) > lengths_(ray.length) * square) {  // the ray's end is nearest
      const Vector off = shifted(1, one) * f - lengths_(ray.length) * direction;
      distance_ = dot(off, off);
      radius_ = shifted(radius * radius, 2 * one);
      return;
    }
    distance_ = dot(f, f) * square - along * along;
    radius_ = radius * radius * square;
  }

  [[nodiscard]] bool hit() const { return distance_ <= radius_; }
  /// distance of the centre from the ray, minus the radius; for a line times |D|, which is 1 to within 1e-12
  [[nodiscard]] double beyond() const { return difference_of_roots(distance_, radius_, exponent_); }

 private:
  Units lengths_, directions_;
  int exponent_ = 0;
  Integer distance_, radius_;
};

}  // namespace detp::support
