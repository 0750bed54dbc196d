#pragma once

#include "detp/model/vocabulary/workload.hpp"

/// Workloads that several tests use.
namespace detp::support {

inline const Workload typical = cube_workload(1e6, 1e5, 0.01, 2);
inline const Workload few_rays = cube_workload(1e4, 1e5, 0.01, 2);

}  // namespace detp::support
