#pragma once

/// The words that prediction and simulation share, and nothing else: no formula of a model is reachable from here.
#include "checks.hpp"
#include "counts.hpp"
#include "engine.hpp"
#include "saturated.hpp"
#include "technique.hpp"
#include "unit_costs.hpp"
#include "units.hpp"
#include "workload.hpp"
