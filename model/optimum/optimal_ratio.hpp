#pragma once

/// The radius ratio of the sphere cache in closed form.
///
/// With many samples of dimension D, and spheres down to far below the scene's size, m_i ∝ r_i^{-D} and n_i ∝ r_i², so
/// T_R ∝ Σ_i Q^{-(D-2)i-2}. The sum's largest terms are the innermost ones, whose size is fixed by d for any Q:
/// T_R ∝ 1/(Q² (1 - Q^{D-2})), or 1/(Q² ln(1/Q)) for D = 2.
///
/// This explains the published "0.6 to 0.7". The formula neglects the steps of k, finite n_P and the other terms of T;
/// `best_ratio` includes them.
namespace detp::model {

/// Q* = (2/D)^{1/(D-2)}: 2/3 for volumes, e^{-1/2} = 0.607 for surfaces.
///
/// Source     our derivation (dT_R/dQ = 0).
/// Accuracy   1.1e-16 compared with 100 digits, over 10⁶ values of D from 1 to 3, most of them close to 1, 2 or 3 (at
///            distances down to 1e-17); monotone (tests/model/hard_cases). Needs long double's 64-bit mantissa.
/// Throws     std::invalid_argument unless 1 <= D <= 3.
[[nodiscard]] double optimal_ratio(double dimension);

}  // namespace detp::model
