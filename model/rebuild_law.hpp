#pragma once

#include "vocabulary.hpp"

/// How often a sphere of the cache must be rebuilt along the Lebesgue curve, corrected: m_i.
///
/// One ball alone. A ball of radius ρ is centred at a sample and kept as long as the next samples lie in it. The curve
/// is self-similar under halving, so that the share m/n of samples that start a new ball depends, but for the ends of
/// the cube, on two numbers only:
///
///     m/n = F_D(λ, φ)      λ = n ρ^D / extent      φ = frac(log₂(s/ρ))
///
///   where  n        samples;   D   their dimension;   extent   the volume (D = 3) or area (D = 2) that they fill
///          ρ        radius of the ball, length: r_i - d, for the disc must lie in the sphere, not only its centre
///          s        side of the curve's cube, length
///          λ        samples in a cube of side ρ;   φ   where ρ lies between two halvings
///
/// F_D → 1 for λ → 0 (each sample starts a ball) and ∝ 1/λ for λ → ∞: m ∝ ρ^{-D}, times a factor periodic in log ρ that
/// varies by a factor of two. Balls larger than a sixteenth of the cube see its ends: their counts, in a cube or on its
/// faces, are tabulated apart.
///
/// Nested balls. S_i is also rebuilt where an outer sphere is. That adds nothing where S_i would have been left at the
/// same sample anyway. With s_i the rebuilds of S_i alone:
///
///     m_i = (s_i + α m_{i-1}) / (1 + α m_{i-1}/n)
///
///   where  α    share of the outer sphere's rebuilds that come at a sample at which S_i alone would have stayed; by
///               renewal theory ½ if S_i moved in equal steps that knew nothing of S_{i-1}; it depends on the ratio of
///               the two balls and, as both follow the same curve, on the phase
///
/// All is tabulated (rebuild_law_tables.inc, made by validate/tables/rebuild_law_table.cpp).
namespace detp::model {

/// m/n of one ball alone, in (0, 1].
///
/// Source     our tabulation.  Accuracy  of the table 2 %; between D = 2 and 3 the geometric interpolation is a guess.
/// Throws     std::invalid_argument unless λ >= 0, 0 <= φ <= 1 and 1 <= D <= 3.
[[nodiscard]] double single_rebuild_share(double dimension, double lambda, double phase);

/// s_i: rebuilds of one ball of radius ρ for the workload's samples, from 1 to n_P. ρ <= 0: each sample.
[[nodiscard]] double single_rebuilds(const Workload& workload, double radius, SampleOrder order);

/// α of a ball of radius ρ_i inside one of radius ρ_{i-1}.
///
///     α = α₀(ρ_i/ρ_{i-1}, φ) (1 - c (s_i/n)⁴) (1 - e ρ_i/s)
///
///   ratio      ρ_i/ρ_{i-1}, in [0, 1]
///   halvings   log₂(s/ρ_i), whose fraction is φ
///   alone      s_i/n, in [0, 1]
///
/// Source     α₀: our tabulation for small balls that hold many samples; c and e (0.5 and 0.4 for D = 2, 0.33 and 0.1
/// for
///            D = 3): our fit to counted walks. Below the tabulated ratio of 0.2 α matters little, for m_{i-1} is then
///            small beside m_i.
[[nodiscard]] double chain_share(double dimension, double ratio, double halvings, double alone);

/// m_i from the rebuilds of S_i alone and those of S_{i-1}.
[[nodiscard]] double chained_rebuilds(double alone, double outer, double share, double samples);

}  // namespace detp::model
