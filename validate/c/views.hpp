#pragma once

#include "detp.h"
#include "detp/sim/search/views.hpp"

/// The caller's arrays as views of detp::sim.
namespace detp::c {

/// Throws std::invalid_argument for null arrays, unknown types and a bad size of the struct.
[[nodiscard]] sim::RaysView view_of(const detp_rays* rays);
[[nodiscard]] sim::DiscsView view_of(const detp_discs* discs);

}  // namespace detp::c
