#pragma once

/// The words that prediction and simulation share, and nothing else: no formula of a model is reachable from here.
#include "vocabulary/checks.hpp"
#include "vocabulary/counts.hpp"
#include "vocabulary/engine.hpp"
#include "vocabulary/saturated.hpp"
#include "vocabulary/technique.hpp"
#include "vocabulary/unit_costs.hpp"
#include "vocabulary/units.hpp"
#include "vocabulary/workload.hpp"
