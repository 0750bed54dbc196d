#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"

/// The workloads on which the formulas are compared with counts: uniform samples in a cube of side 2 or on its faces.
namespace detp::validate {

/// One workload of the sweep, and the numbers of sets and lines to simulate.
struct SweepPoint {
  int dimension = 3;
  double samples = 0;     ///< n_P
  double disc_share = 0;  ///< d/r₀
  int sets = 0;           ///< independent sets of samples
  std::size_t lines = 0;  ///< isotropic lines through S₀ for each set

  [[nodiscard]] double disc_radius() const;
  [[nodiscard]] Workload workload() const;
  [[nodiscard]] std::vector<sim::Disc> discs(std::uint64_t seed, int set, const std::stop_token& stop = {}) const;

  /// The name of the point, unique in the sweep: "D=3 n=1000 d/r0=0.01".
  [[nodiscard]] std::string name() const;
};

/// All points: n_P 10³ … 10⁷, d/r₀ 10⁻⁴ … 0.2, D 2 and 3. Points with most samples come first, so that all threads
/// finish at about the same time.
[[nodiscard]] std::vector<SweepPoint> sweep_points();

/// The candidates to run on a point: sphere caches with five Q, indices and hierarchies with two resolutions, box trees
/// with five leaf sizes. Candidates with more than 10⁹ predicted tests, nodes and steps on one set are left out.
[[nodiscard]] std::vector<Candidate> sweep_candidates(const SweepPoint& point);

}  // namespace detp::validate
