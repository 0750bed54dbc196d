#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::validate {

/// Unit costs measured by `detp calibrate` on one core of a cloud machine with AVX-512. Times on another machine may
/// differ by a factor of two, or by the ratio of the vector widths; calibrate that machine.
[[nodiscard]] CostTable built_in_unit_costs();

}  // namespace detp::validate
