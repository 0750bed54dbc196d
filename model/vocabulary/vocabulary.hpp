#pragma once
/// The types that prediction and simulation share.
#include "bytes_touched.hpp"
#include "checks.hpp"
#include "cost_table.hpp"
#include "counts.hpp"
#include "engine.hpp"
#include "prediction.hpp"
#include "saturated.hpp"
#include "technique.hpp"
#include "thread_costs.hpp"
#include "unit_costs.hpp"
#include "valid.hpp"
#include "workload.hpp"
