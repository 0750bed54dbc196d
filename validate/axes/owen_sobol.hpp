#pragma once

#include <array>
#include <cstdint>

/// Sobol's sequence in four dimensions with Owen's scrambling.
namespace detp::validate {

/// Points in [0, 1)⁴. Of any 2ᵏ points that start at a multiple of it, one lies in each of 2ᵏ equal intervals of every coordinate, and in each
/// elementary box of the first two. Scrambling keeps this, and makes each point of a replicate (seed) uniform. The
/// direction numbers are those of S. Joe and F. Kuo (2008); the scrambling is by hashing (B. Burley, JCGT 9/4, 2020).
class OwenSobol {
 public:
  explicit OwenSobol(std::uint64_t seed) : seed_(seed) {}

  [[nodiscard]] std::array<double, 4> point(std::uint32_t index) const {
    std::array<double, 4> point{};
    for (std::size_t dimension = 0; dimension < point.size(); ++dimension) {
      const std::uint32_t word = scrambled(sobol(index, dimension), hashed(seed_ * 4 + dimension));
      point[dimension] = word * 0x1p-32;
    }
    return point;
  }

 private:
  static constexpr std::size_t bits = 32;
  using Directions = std::array<std::array<std::uint32_t, bits>, 4>;

  /// Polynomials of degree s with the inner coefficients a, and first numbers m.
  [[nodiscard]] static constexpr Directions make_directions() {
    struct Polynomial {
      std::size_t degree;
      std::uint32_t inner;
      std::array<std::uint32_t, 3> first;
    };
    constexpr std::array<Polynomial, 3> polynomials{{{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}}};
    Directions all{};
    for (std::size_t bit = 0; bit < bits; ++bit) all[0][bit] = 1U << (31 - bit);
    for (std::size_t dimension = 1; dimension < all.size(); ++dimension) {
      const auto& [degree, inner, first] = polynomials[dimension - 1];
      auto& v = all[dimension];
      for (std::size_t bit = 0; bit < bits; ++bit) {
        if (bit < degree) {
          v[bit] = first[bit] << (31 - bit);
          continue;
        }
        v[bit] = v[bit - degree] ^ (v[bit - degree] >> degree);
        for (std::size_t k = 1; k < degree; ++k)
          if ((inner >> (degree - 1 - k)) & 1U) v[bit] ^= v[bit - k];
      }
    }
    return all;
  }

  [[nodiscard]] static std::uint32_t sobol(std::uint32_t index, std::size_t dimension) {
    static constexpr Directions directions = make_directions();
    std::uint32_t word = 0;
    for (std::size_t bit = 0; index != 0; ++bit, index >>= 1)
      if (index & 1U) word ^= directions[dimension][bit];
    return word;
  }

  [[nodiscard]] static std::uint32_t reversed(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
    x = ((x >> 8) & 0x00ff00ffU) | ((x & 0x00ff00ffU) << 8);
    return (x >> 16) | (x << 16);
  }

  /// Each bit is flipped by a hash of the higher ones: after reversal, of the lower ones.
  [[nodiscard]] static std::uint32_t scrambled(std::uint32_t word, std::uint32_t seed) {
    std::uint32_t x = reversed(word) + seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    x ^= x * 0x8d22f6e6U;
    return reversed(x);
  }

  [[nodiscard]] static std::uint32_t hashed(std::uint64_t x) {
    x = (x ^ (x >> 31)) * 0x7fb5d329728ea185ULL;
    x = (x ^ (x >> 27)) * 0x81dadef4bc2dd44dULL;
    return static_cast<std::uint32_t>((x ^ (x >> 33)) >> 16);
  }

  std::uint64_t seed_;
};

}  // namespace detp::validate
