#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::validate {

/// Unit costs of an engine, measured by `detp calibrate` on a cloud machine with AVX-512; the costs of threads are from its
/// two cores. Times on another machine may differ by a factor of two, which is two of CostTable::relative_errors, or by the ratio of the vector widths; calibrate that
/// machine.
[[nodiscard]] CostTable built_in_unit_costs(Engine engine = Engine::simd);

}  // namespace detp::validate
