#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/paths.hpp"

/// Errors against what they cost in time.
namespace detp::validate {

struct AxisInterval {
  double low = 0;
  double high = 0;
};

/// One way to get a number.
struct AxisPoint {
  std::string axis;
  std::string setting;   ///< "Owen-scrambled Sobol, 4096 lines"
  std::string quantity;  ///< whose relative error this is
  double error = 0;
  /// Of the error, 95 %; nothing where it is not known, or where the error is 0 by definition.
  std::optional<AxisInterval> interval = {};
  double seconds = 0;  ///< measured
  double work = 0;     ///< lines, pairs or rays

  /// 1/(error² seconds); infinite without an error
  [[nodiscard]] double merit() const { return 1 / (error * error * seconds); }
};

struct AxisOptions {
  std::uint64_t seed = 1;
  int threads = 0;
  std::stop_token stop = {};
};

/// The probability that a uniform isotropic line through S₀ (the smallest sphere around the discs) hits a disc: d²/(2r₀²), exactly (Santaló,
/// Integral Geometry, II.12). Up to 16 of the discs; 16 replicates of 2¹² and 2¹⁵ lines each:
///
///     plain            random lines                          stratified    one in each cell of a lattice in the four coordinates
///     Owen-scrambled   Sobol points (owen_sobol.hpp)         conditioned   only directions: given ω, a line hits with d²|n·ω|/r₀²
///
/// Error: root mean square over discs and replicates. Throws as sim::enclosing_sphere; sim::Stopped.
[[nodiscard]] std::vector<AxisPoint> simulation_axis(std::span<const sim::Disc> discs, const AxisOptions& options);

/// Tests and seconds of the search, predicted with rigor estimate, structural and pilot, and by counting all rays, against the full run.
/// Seconds: of choosing; of the full run, of the search. Throws as choose; sim::Stopped.
[[nodiscard]] std::vector<AxisPoint> model_axis(const sim::PathRays& rays, std::span<const sim::Disc> discs,
                                                const CostTable& costs, const AxisOptions& options);

/// Decisions whether a ray hits a disc, wrong ones over hits: in float without a filter, in float with the filter of our kernels, in double, and
/// exactly (100 digits); in an ordinary scene, and in a hard one: far from the origin, rays aimed at the rims. Nothing wrong is a bound: at
/// most 3/hits. Throws sim::Stopped.
[[nodiscard]] std::vector<AxisPoint> arithmetic_axis(const AxisOptions& options);

}  // namespace detp::validate
