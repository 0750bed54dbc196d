#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// How often a sphere of the cache must be rebuilt along the Lebesgue curve, corrected: m_i.
///
/// One ball alone. A ball of radius ρ is centred at a sample and kept as long as the next samples lie in it. The curve
/// is self-similar under halving, so that the share m/n of samples that start a new ball depends, but for the ends of
/// the cube, on two numbers only:
///
///     m/n = F_D(λ, φ)      λ = n ρ^D / extent      φ = frac(h),  h = log₂(s/ρ)
///
///   where  n        samples;   D   their dimension;   extent   the volume (D = 3) or area (D = 2) that they fill
///          ρ        radius of the ball, length: r_i - d, for the disc must lie in the sphere, not only its centre
///          s        side of the curve's cube, length;   h   halvings from it to the ball
///          λ        samples in a cube of side ρ;   φ   where ρ lies between two halvings
///
/// F_D → 1 for λ → 0 (each sample starts a ball) and ∝ 1/λ for λ → ∞: m ∝ ρ^{-D}, times a factor periodic in log ρ that
/// varies by a factor of two, with jumps where the ball just holds a cell of the curve. Balls larger than a sixteenth
/// of the cube see its ends: their counts, in a cube or on its faces, are tabulated apart, by quarters of a decade in
/// n: the more samples, the smaller the ball at which the count jumps, so that between whole decades it would be
/// smoothed.
/// Against 355 such spheres of nests, r_i from 0.3 of the side, at random n_P 10³ … 10⁶ and Q over other samples, m_1
/// is off by 0.4, 1.9, 3.5 % (D = 2: median, 95th percentile, worst) and 0.6, 3.1, 8.1 % (D = 3), those inside it
/// by 1.1, 4.7, 5.9 % and 1.2, 4.0, 10.0 %; the noise is 0.6 % in the mean.
///
/// Nested balls. S_i is rebuilt where the sphere around it is, and at those of its own rebuilds that still come:
///
///     m_i = m_{i-1} + s_i (1 - m_{i-1}/n) w      w = exp(-b m_{i-1}/s_i)
///
///   where  s_i  rebuilds of S_i alone;   m_{i-1}/s_i   how crowded they are by those of the sphere around it
///          w    share of them that remain at samples at which the outer sphere stays: would S_i move in equal steps
///               that knew nothing of S_{i-1}, b would be about ½; as both follow the same curve, it depends on the
///               ratio of the balls, on their phase and on λ
///
/// For ever more spheres (ratio → 1) the samples' own distance matters: a ball that is but a little smaller than the
/// one around it is left alone only if a sample lands between both. So w ∝ the logarithm of the ratio, once that is
/// less than the distance of samples over ρ, λ^{-1/D}.
///
/// All is tabulated (rebuild_law_tables.inc, made by validate/tools/rebuild_law_table.cpp).
namespace detp::model {

/// A ball around a sample, as the curve sees it.
struct Ball {
  double lambda = 0;    ///< λ: samples in a cube of its radius
  double halvings = 0;  ///< h = log₂(s/ρ)
};

/// The ball of radius ρ > 0 among the workload's samples. Throws std::invalid_argument for numbers out of range.
[[nodiscard]] Ball ball_of(const Workload& workload, double radius);

/// m/n of one small ball alone, in (0, 1].
///
/// Source     our tabulation.  Accuracy  of the table 1 % (the nearer to a jump in φ, the less: up to 5 %); between
///            D = 2 and 3 the geometric interpolation is a guess.
/// Throws     std::invalid_argument unless λ >= 0, 0 <= φ <= 1 and 1 <= D <= 3.
[[nodiscard]] double single_rebuild_share(double dimension, double lambda, double phase);

/// s_i along the curve: rebuilds of one ball alone among so many samples, from 1 to all.
[[nodiscard]] double single_rebuilds(double dimension, double samples, const Ball& ball);

/// Throws std::invalid_argument for the Hilbert order: the law is tabulated along the Lebesgue curve, and there is no
/// formula for another.
void require_rebuild_law(SampleOrder order);

/// The same for the workload's samples in order or in none. ρ <= 0: each sample. Throws as require_rebuild_law does.
[[nodiscard]] double single_rebuilds(const Workload& workload, double radius, SampleOrder order);

/// w: share of a ball's own rebuilds that remain inside another.
///
///   octaves    log₂(ρ_{i-1}/ρ_i), >= 0; tabulated from 1/16 to 9/4, beyond which b is kept
///   crowding   m_{i-1}/s_i, >= 0
///
/// Source     b: our tabulation over nests of one ratio. Below 1/16 of an octave w is taken from there, at the crowding
///            that such a nest has, and lowered by (1 - e^{-x}) in x = octaves/(c λ^{-1/D}); c = 0.9 (D = 2) and 0.45
///            (D = 3): our fit to nests of 1/32 … 1/256.
/// Throws     std::invalid_argument for a number out of range.
[[nodiscard]] double own_rebuild_share(double dimension, const Ball& ball, double octaves, double crowding);

/// m_i from the rebuilds of S_i alone, those of S_{i-1} and w. From m_{i-1} to n.
[[nodiscard]] double nested_rebuilds(double alone, double outer, double own_share, double samples);

}  // namespace detp::model
