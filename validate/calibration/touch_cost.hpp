#pragma once

#include "calibrate.hpp"

namespace detp::validate {

/// Measures UnitCosts::touch and sets it for all techniques: seconds for touching a byte of memory for the first time, in large pages where
/// the system offers them, as searches do. The shortest of some tries; a few milliseconds in all. Where there is no memory for it, the costs
/// stay.
void set_touch_cost(Calibration& calibration);

}  // namespace detp::validate
