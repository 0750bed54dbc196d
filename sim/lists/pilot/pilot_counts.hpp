#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::sim::stream {

/// How a count grows with the discs' radius: by first (σ - 1) + second (σ - 1)², σ being the radius over the pilot's.
struct RadiusGrowth {
  double first = 0;
  double second = 0;

  [[nodiscard]] double at(double ratio) const { return (first + second * (ratio - 1)) * (ratio - 1); }
};

/// Counts of a box tree, predicted by a pilot.
struct PilotCounts {
  Counts<double> counts;  ///< of the search of all rays, building included
  Counts<double> error;   ///< standard errors of the counts; 0: the count is exact
  RadiusGrowth cull_tests;
  RadiusGrowth listed;
  RadiusGrowth disc_tests;
  double nodes = 0;  ///< of the tree, without the root

  /// The counts of the same tree with the radius multiplied by `radius_ratio`, and with `rays` rays of the same
  /// distribution. Takes about a microsecond: nothing is culled. Our derivation:
  ///
  ///     A(σ) = Σ_i<j (s_i + g_i (σ - 1)) (s_j + g_j (σ - 1)),  g_i = min(s_i, 2d)
  ///
  ///   where  A  half the surface of a node's box; the rays in its list are proportional to it (PilotCounts::cull_tests,
  ///             listed and disc_tests are the sums over all nodes)
  ///          σ  radius_ratio
  ///          s  sides of the box with the pilot's radius d (root mean square, if radii differ)
  ///
  /// Lists are made, and discs visited, if a block of rays has a ray there. The share of the rays in a list is taken as
  /// a gamma variable, with the variance for which the pilot's radius and number of rays give the pilot's counts. Hits
  /// are proportional to σ². Nodes are split as with the pilot's radius.
  ///
  /// Exact at σ = 1 with the pilot's number of rays. Errors for 4000 uniform samples of a cube, or of its faces, with
  /// d = 0.05, 600 to 15 000 lines, and leaves of 8 and 64 (tests/sim/lists/pilot/pilot_counts.test.cpp): up to 13 % for
  /// σ = 0.5 … 2; up to 34 % for σ = 0.25 … 4, because larger discs make larger leaves. Throws
  /// std::invalid_argument unless the ratio is > 0 and finite, and for a number of rays out of 1 … 1e18.
  [[nodiscard]] Counts<double> at(double radius_ratio, double rays) const;
};

}  // namespace detp::sim::stream
