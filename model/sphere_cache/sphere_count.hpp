#pragma once

#include <cstdint>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// Index k of the innermost sphere, which has the radius r_k = r₀Q^k.
///
///     published   k = ⌈log_Q(d/r₀)⌉     the smallest k with r_k <= d
///     corrected   k = ⌊log_Q(d/r₀)⌋     the largest k with r_k >= d
///
///   where  d    disc radius, length;   r₀   radius of S₀, length;   Q   radius ratio
///
/// The paper requires r_k >= d > r_{k+1} (eq 6), which its eq 7 contradicts: rounding up makes the innermost sphere
/// smaller than the disc that it should contain.
///
/// Source     eq (7); corrected: eq (6).
/// Valid      any positive doubles d and r₀, any Q between 0 and 1, including subnormal ones.
/// Limits     d >= r₀: 0, no sphere pays off.  Q → 1: k ≈ ln(r₀/d)/(1-Q).
/// Accuracy   exact for the doubles passed, including ties: near a whole number the powers are compared in 100 digits,
///            with an error below k 1e-100. Right for all of 10⁶ inputs log-uniform over that domain, half of them with
///            d within an ulp of an r₀Qⁱ (tests/model/hard_cases); monotone in Q and d.
/// Throws     std::invalid_argument unless 0 < Q < 1, d and r₀ > 0 and finite; std::overflow_error above 9e18, which no
///            workload reaches: with r₀ <= 1e90, d >= 5e-324 and Q <= 1 - 2⁻⁵³, k <= 8.6e18.
[[nodiscard]] std::int64_t sphere_count(Form form, RadiusRatio ratio, DiscRadius disc, SphereRadius outer);

}  // namespace detp::model
