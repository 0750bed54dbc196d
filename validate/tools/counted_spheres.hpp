#pragma once

#include <fmt/format.h>

#include <cmath>

#include "listed_rays_table.hpp"
#include "sample_walk.hpp"

/// Counted reference values for the tests of the model: rebuilds and listed rays of some spheres of some caches. The
/// seeds differ from those of the tables.
namespace detp::tables {

/// Prints rows {D, n_P, d/r₀, Q, i, m_i, share of the rays through S_i that are in the list of S_i}.
inline void print_counted_spheres() {
  constexpr std::uint64_t seed = 31'000'000;
  for (const int dimension : {2, 3})
    for (const std::size_t count : {1'000UL, 100'000UL}) {
      std::vector<Points> sets;
      for (std::uint64_t set = 0; set < (count == 1'000 ? 400 : 24); ++set)
        sets.push_back(sorted_samples(dimension, count, seed + set));
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
