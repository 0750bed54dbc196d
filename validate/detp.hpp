#pragma once

/// The header for a program that embeds detp: plans a search for rays and discs, and executes it; measures the unit costs
/// of the machine, or reads those that were stored; plans how many photon paths, which setting and which estimator reach an
/// error; searches batches of rays until an error is reached; does what `detp run` does.
/// Headers of single formulas (detp/model), scenes and rays (detp/sim) and claims (detp/validate) are installed too.
#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/validate/accuracy/accuracy_check.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/choice/plan.hpp"
#include "detp/validate/run/run.hpp"
#include "detp/validate/stopping/execute_until.hpp"
