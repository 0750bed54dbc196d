#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "sample_walk.hpp"

/// The share of the lines through a sphere of the cache that do not cross all spheres around it, averaged over the
/// builds of the sphere: these rays are missing in the sphere's list.
namespace detp::tables {

inline constexpr std::array list_octaves{0.074, 0.152, 0.234, 0.322, 0.42, 0.515, 0.62, 0.737, 1.0, 1.32, 1.74, 2.32};
inline constexpr std::array list_disc_shares{0.0, 0.1, 0.25, 0.45, 0.65, 0.85, 1.0};  ///< d/r_i
inline constexpr std::array list_outer_disc_shares{0.0, 0.05, 0.2};                   ///< d/r₀

/// Measures this share for the innermost of nested spheres, at some of its builds.
class ListedShare {
 public:
  /// `radii` start with that of the outermost sphere, which stays around the origin if `fixed_outermost` is true.
  ListedShare(std::vector<double> radii, double disc_radius, bool fixed_outermost)
      : radii_(std::move(radii)), fixed_(fixed_outermost ? 1 : 0) {
    for (std::size_t i = fixed_; i < radii_.size(); ++i) balls_.push_back(std::max(0.0, radii_[i] - disc_radius));
  }

  /// Counts at about `builds` random builds of the innermost sphere in a walk along the samples, with `lines` lines
  /// each.
  void walk(const Points& samples, double builds, int lines) {
    const double share = std::min(1.0, builds / moves(samples, balls_).back());
    NestedBalls nest(balls_);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      if (nest.visit(samples[n]) == balls_.size()) continue;
      if (sim::uniform4(1, sim::Stream::tests, n)[0] < share) place_lines(nest, lines);
    }
  }

  [[nodiscard]] double lost() const { return 1 - crossing_ / laid_; }

 private:
  static bool crosses(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& centre, double radius) {
    const glm::dvec3 w = point - centre;
    const double along = glm::dot(w, direction);
    return glm::dot(w, w) - along * along <= radius * radius;
  }

  void place_lines(const NestedBalls& nest, int lines) {
    static const std::vector<sim::Ray> pool = sim::LineField({}, 1).lines(0, 65536);
    for (int n = 0; n < lines; ++n) {
      const sim::Ray& line = pool[next_++ % pool.size()];
      const glm::dvec3 point = nest.centre(balls_.size() - 1) + radii_.back() * line.origin;
      std::size_t outer = radii_.size() - 1;  // the line crosses all tested spheres, from this one on
      while (outer > 0) {
        const glm::dvec3 centre = outer > fixed_ ? nest.centre(outer - 1 - fixed_) : glm::dvec3{0.0};
        if (!crosses(point, line.direction, centre, radii_[outer - 1])) break;
        --outer;
      }
      crossing_ += outer == 0 ? 1 : 0;
      ++laid_;
    }
  }

  std::vector<double> radii_, balls_;
  std::size_t fixed_;
  std::size_t next_ = 0;
  double crossing_ = 0, laid_ = 0;
};

/// The radii of a sphere and of the spheres around it, outermost first. Each radius up to `largest` is 2^octaves times
/// the next.
inline std::vector<double> spheres_around(double radius, double octaves, double largest) {
  std::vector<double> radii;
  for (double r = radius; r <= largest; r *= std::exp2(octaves)) radii.push_back(r);
  std::reverse(radii.begin(), radii.end());
  return radii;
}

/// Prints the table for spheres deep in the scene, without S₀. Each value is the mean over three sets of samples, of
/// which each has 2^{-D/3} times as many samples as the one before.
inline void print_deep_lists() {
  constexpr std::uint64_t seed = 900;
  for (const int dimension : {2, 3})
    for (int power = -12; power <= 12; power += 2) {
      const double cells = std::exp2(power + 5.0 * dimension) * extent_of(dimension) / std::pow(side, dimension);
      std::vector<Points> sets;
      for (int third = 0; third < 3; ++third)
        sets.push_back(sorted_samples(
            dimension,
            static_cast<std::size_t>(std::clamp(cells, 0x1p16, 0x1p22) * std::exp2(-dimension * third / 3.0)),
            seed + static_cast<std::uint64_t>(third)));
      for (const double octaves : list_octaves) {
        for (const double disc : list_disc_shares) {
          double lost = 0;
          for (const Points& samples : sets) {
            const double radius = std::pow(
                std::exp2(power) * extent_of(dimension) / static_cast<double>(samples.size()), 1.0 / dimension);
            ListedShare share(spheres_around(radius, octaves, side * std::sqrt(0.75)), std::min(disc, 0.9999) * radius,
                              false);
            share.walk(samples, 7000, 16);
            lost += share.lost() / 3;
          }
          fmt::print("{:.4f},", lost);
        }
        fmt::print("\n");
      }
    }
}

/// Prints the table for spheres near S₀: for 10³ and 10⁵ samples, by d/r₀, then by log₂(r₀/r_i) from 0.25 to 4.
inline void print_shallow_lists() {
  constexpr std::uint64_t seed = 700;
  for (const int dimension : {2, 3})
    for (const std::size_t count : {1'000UL, 100'000UL}) {
      const std::vector<Points> sets = sets_of(dimension, count, count == 1'000 ? 400 : 12, seed);
      for (const double outer_disc : list_outer_disc_shares)
        for (int quarter = 1; quarter <= 16; ++quarter) {
          for (const double octaves : list_octaves) {
            const double outermost = side * std::sqrt(0.75) / (1 - outer_disc);
            const double radius = outermost * std::exp2(-quarter / 4.0);
            std::vector<double> radii = spheres_around(radius, octaves, outermost * std::exp2(-octaves / 2));
            if (radii.empty()) radii.push_back(radius);
            radii.insert(radii.begin(), outermost);
            ListedShare share(radii, outer_disc * outermost, true);
            for (const Points& samples : sets) share.walk(samples, 7200 / static_cast<double>(sets.size()), 16);
            fmt::print("{:.4f},", share.lost());
          }
          fmt::print("\n");
        }
    }
}

inline void print_listed_rays() {
  fmt::print("constexpr std::array<double, 2 * densities * octave_grid.size() * disc_shares.size()> deep_table{{{{\n");
  print_deep_lists();
  fmt::print(
      "}}}};\n\nconstexpr std::array<double, 2 * shallow_samples.size() * outer_disc_shares.size() * depths * "
      "octave_grid.size()> ");
  fmt::print("shallow_table{{{{\n");
  print_shallow_lists();
  fmt::print("}}}};\n");
}

/// Counted reference values for the tests of the model: rebuilds and listed rays of some spheres of some caches. The seeds differ from those
/// of the tables. Prints rows {D, n_P, d/r₀, Q, i, m_i, share of the rays through S_i that are in the list of S_i}.
inline void print_counted_spheres() {
  constexpr std::uint64_t seed = 31'000'000;
  for (const int dimension : {2, 3})
    for (const std::size_t count : {1'000UL, 100'000UL}) {
      const std::vector<Points> sets = sets_of(dimension, count, count == 1'000 ? 400 : 24, seed);
      for (const double disc : {0.001, 0.05})
        for (const double ratio : {0.5, 0.8, 0.9}) {
          const double outermost = side * std::sqrt(0.75) / (1 - disc);
          std::vector<double> radii{outermost};
          for (int i = 1; outermost * std::pow(ratio, i) >= disc * outermost; ++i) {
            radii.push_back(outermost * std::pow(ratio, i));
            if (i != (ratio > 0.85 ? 6 : 2) && i != (ratio > 0.85 ? 18 : ratio > 0.6 ? 8 : 3)) continue;
            std::vector<double> balls;
            for (std::size_t j = 1; j < radii.size(); ++j) balls.push_back(radii[j] - disc * outermost);
            ListedShare share(radii, disc * outermost, true);
            double rebuilds = 0;
            for (const Points& samples : sets) {
              rebuilds += moves(samples, balls).back() / static_cast<double>(sets.size());
              share.walk(samples, 10'000 / static_cast<double>(sets.size()), 16);
            }
            fmt::print("{{{}, {}, {}, {}, {}, {:.2f}, {:.4f}}},\n", dimension, count, disc, ratio, i, rebuilds,
                       1 - share.lost());
          }
        }
    }
}

}  // namespace detp::tables
