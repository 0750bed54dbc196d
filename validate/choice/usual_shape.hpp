#pragma once

#include "detp/model/vocabulary/parameters.hpp"

namespace detp::validate {

/// A good box tree for that many rays and discs, without a look at them: fan-out 8, and leaves of
///
///     24 (n_P/n_R)^0.3, rounded to a power of two from 8 to 512
///
/// Few rays do not pay for small leaves.
///
/// Source     fitted to exact counts, priced with the built-in unit costs, of fan-outs 4 to 32 with leaves 8 to 512, on
///            lines and photon paths, 10² to 10⁵ rays, radii of 0.25 to 4 % of the scene: @courtyard and @tree.
/// Accuracy   time over that of the best of these 28 shapes, priced alike: 0.2 % more in the geometric mean of 32
///            workloads of these scenes, at most 1.5 %; on four meshes that were not fitted (64 workloads) 0.3 %, at most
///            3.1 %. Fan-out 8 with leaves of 32 takes 2.4 % more on all, at most 9 %.
/// Throws     std::invalid_argument unless both numbers are from 1 to 1e18.
[[nodiscard]] BoxTreeParameters usual_shape(double rays, double discs);

}  // namespace detp::validate
