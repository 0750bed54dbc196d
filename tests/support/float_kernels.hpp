#pragma once

#include <algorithm>
#include <cmath>

#include "detp/sim/lists/simd/disc_tree.hpp"

/// A second implementation of the float kernels (sim/lists/simd/kernels-inl.hpp), for one ray and any number type:
/// floats, with and without fused operations, and long double as the reference.
namespace detp::support {

/// A ray and a disc in the coordinates of the ray's class.
template <class Real>
struct KernelCase {
  Real a, b, p, q, from, to;
  Real centre[3];
  Real normal[3];
  Real radius;
};

template <class Real, bool fused>
struct Kernel {
  static Real mul_add(Real a, Real b, Real c) {
    if constexpr (fused)
      return std::fma(a, b, c);
    else
      return a * b + c;
  }

  /// The values that decide whether the ray hits the disc. sim/lists/simd/floats.md explains the symbols.
  struct Disc {
    Real rim;      ///< |V| - d|φ|: <= 0 for hits
    Real facing;   ///< φ
    Real after;    ///< >= 0: crosses above the segment's lower end
    Real before;   ///< >= 0: crosses below the segment's upper end
    Real beside;   ///< |w|
    Real highest;  ///< the larger distance in z from the centre to an end of the segment
  };

  explicit Kernel(const KernelCase<Real>& of) : ray(of) {
    P = mul_add(ray.a, ray.centre[2], ray.p) - ray.centre[0];
    Q = mul_add(ray.b, ray.centre[2], ray.q) - ray.centre[1];
  }

  [[nodiscard]] Disc disc() const {
    const Real* n = ray.normal;
    const Real facing = mul_add(n[0], ray.a, mul_add(n[1], ray.b, n[2]));
    const Real height = mul_add(n[0], P, n[1] * Q);
    const Real X = mul_add(-ray.a, height, P * facing);
    const Real Y = mul_add(-ray.b, height, Q * facing);
    const Real square = mul_add(X, X, mul_add(Y, Y, height * height));
    const Real size = std::abs(facing);
    const Real along = std::signbit(facing) ? height : -height;
    return {.rim = std::sqrt(square) - ray.radius * size,
            .facing = facing,
            .after = mul_add(-(ray.from - ray.centre[2]), size, along),
            .before = mul_add(ray.to - ray.centre[2], size, -along),
            .beside = std::sqrt(P * P + Q * Q),
            .highest = std::max(std::abs(ray.from - ray.centre[2]), std::abs(ray.to - ray.centre[2]))};
  }

  /// The ray's distance from the centre.
  [[nodiscard]] double distance() const {
    const Real turn = mul_add(P, ray.b, -(Q * ray.a));
    const Real moment = mul_add(P, P, mul_add(Q, Q, turn * turn));
    const Real stretch = mul_add(ray.a, ray.a, mul_add(ray.b, ray.b, Real{1}));
    return static_cast<double>(std::sqrt(static_cast<long double>(moment) / static_cast<long double>(stretch)));
  }

  /// By how much a box around `centre` must grow for the ray to be listed.
  [[nodiscard]] Real beyond_box(const Real (&half)[3], bool segment) const {
    const Real x = mul_add(-std::abs(ray.a), half[2], std::abs(P)) - half[0];
    const Real y = mul_add(-std::abs(ray.b), half[2], std::abs(Q)) - half[1];
    Real beyond = std::max(x / (1 + std::abs(ray.a)), y / (1 + std::abs(ray.b)));
    if (segment) beyond = std::max({beyond, ray.from - (ray.centre[2] + half[2]), (ray.centre[2] - half[2]) - ray.to});
    return beyond;
  }

  KernelCase<Real> ray;
  Real P, Q;
};

}  // namespace detp::support
