#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// How often a sphere of the cache is rebuilt along the Morton curve (the paper: Lebesgue curve): m_i, corrected.
///
/// One ball alone. A ball of radius ρ is centred at a sample and kept while the next samples lie in it. The curve is
/// self-similar under halving. So, away from the cube's faces, the share m/n of samples that start a new ball depends
/// on only two numbers:
///
///     m/n = F_D(λ, φ)      λ = n ρ^D / extent      φ = frac(h),  h = log₂(s/ρ)
///
///   where  n        samples;   D   their dimension;   extent   the volume (D = 3) or area (D = 2) that they fill
///          ρ        radius of the ball, length: r_i - d, because the whole disc must lie in the sphere
///          s        side of the curve's cube, length;   h   halvings from the cube to the ball
///          λ        samples in a cube of side ρ;   φ   place of ρ between two halvings
///
/// F_D → 1 for λ → 0: each sample starts a ball. F_D ∝ 1/λ for λ → ∞. Then m is ρ^{-D} times a factor that is periodic
/// in log ρ and varies by a factor of two; it jumps where the ball just contains a cell of the curve.
///
/// The cube's faces affect balls of radius ρ > s/16. The counts of such balls, in a cube or on its faces, have a table
/// of their own, with four values of n per decade. The radius at which a count jumps decreases as n increases, so
/// interpolation between whole decades would smooth the jumps. The table was compared with 355 such balls in nested
/// spheres (r_i from 0.3 s; random Q, and random n_P from 10³ to 10⁶; other samples than those of the table). The
/// deviations (median, 95th percentile, largest) of m_1 are 0.4, 1.9, 3.5 % (D = 2) and 0.6, 3.1, 8.1 % (D = 3). Those
/// of m_i, i > 1, are 1.1, 4.7, 5.9 % and 1.2, 4.0, 10.0 %. The mean noise of the counts is 0.6 %.
///
/// Nested balls. S_i is rebuilt whenever S_{i-1} is. At the samples where S_{i-1} stays, S_i also has a share w of the
/// rebuilds that it would have there alone:
///
///     m_i = m_{i-1} + s_i (1 - m_{i-1}/n) w      w = exp(-b m_{i-1}/s_i)
///
///   where  s_i            rebuilds of S_i alone
///          m_{i-1}/s_i    the crowding
///          w              share that remains of the rebuilds that S_i alone would have where S_{i-1} stays. If S_i
///                        moved in equal steps independent of S_{i-1}, b would be about ½. Both follow the same curve,
///                        so b depends on the ratio of the balls, on their phase and on λ
///
/// If the ratio is close to 1, the distance between samples matters: a ball that is only slightly smaller than the ball
/// around it is rebuilt alone only if a sample falls between the two. So w is proportional to the logarithm of the
/// ratio if this logarithm is less than λ^{-1/D}, the distance between samples divided by ρ.
///
/// F, b and the counts of large balls are tabulated (rebuild_law_tables.inc, made by
/// validate/tools/rebuild_law_table.cpp).
namespace detp::model {

/// A ball around a sample, in the numbers of the rebuild law.
struct Ball {
  double lambda = 0;    ///< λ: samples in a cube of side ρ
  double halvings = 0;  ///< h = log₂(s/ρ)
};

/// The ball of radius ρ > 0 among the workload's samples. Throws std::invalid_argument for numbers out of range.
[[nodiscard]] Ball ball_of(const Valid<Workload>& workload, double radius);

/// s_i along the curve: rebuilds of one ball alone, from 1 to `samples`.
///
/// Source     our tabulation.
/// Accuracy   of the table: 1 %, near a jump in φ up to 5 %. The geometric interpolation between D = 2 and 3 is
///            unverified.
/// Throws     std::invalid_argument unless λ >= 0, n > 0, h is finite and 1 <= D <= 3.
[[nodiscard]] double single_rebuilds(double dimension, double samples, const Ball& ball);

/// Throws std::invalid_argument for the Hilbert order: the law is tabulated along the Morton curve, and there is no
/// formula for other curves.
void require_rebuild_law(SampleOrder order);

/// Rebuilds of one ball alone among the workload's samples, sorted or unsorted. If ρ <= 0, each sample causes a
/// rebuild. Throws as require_rebuild_law does.
[[nodiscard]] double single_rebuilds(const Valid<Workload>& workload, double radius, SampleOrder order);

/// w: the share of a ball's own rebuilds that remain if another ball is around it.
///
///   octaves    log₂(ρ_{i-1}/ρ_i), >= 0; tabulated from 1/16 to 9/4; beyond 9/4 b is constant
///   crowding   m_{i-1}/s_i, >= 0
///
/// Source     b: our tabulation over nests of one ratio. Below 1/16 of an octave, w is its value at 1/16 (with at most
///            the crowding of a nest of that ratio) times a factor proportional to 1 - e^{-x}, x = octaves/(c
///            λ^{-1/D}). c = 0.9 (D = 2) and 0.45 (D = 3) are our fit to nests of 1/32 … 1/256.
/// Throws     std::invalid_argument for a number out of range.
[[nodiscard]] double own_rebuild_share(double dimension, const Ball& ball, double octaves, double crowding);

/// m_i, from the formula above: `alone` is s_i, `outer` is m_{i-1}, `own_share` is w, `samples` is n. The result is at
/// least m_{i-1} and at most n. Throws std::invalid_argument for a number out of range.
[[nodiscard]] double nested_rebuilds(double alone, double outer, double own_share, double samples);

}  // namespace detp::model
