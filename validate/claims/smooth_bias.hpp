#pragma once

#include "claim.hpp"

namespace detp::validate {

/// The bias of discs in smooth light (c₄ of model/accuracy/scene_error.hpp): parallel light whose Laplacian is the same everywhere,
/// so that no higher term adds to the bias. Throws sim::Stopped.
[[nodiscard]] Finding smooth_bias_finding(const Experiment& experiment);

}  // namespace detp::validate
