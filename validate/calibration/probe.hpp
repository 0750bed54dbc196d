#pragma once

#include <stop_token>

#include "calibrate.hpp"

/// Costs of a machine that was not calibrated.
namespace detp::validate {

/// The built-in costs of each technique and engine, times one factor each: the measured over the predicted seconds of a few short searches, on one
/// thread, in processor time; the geometric mean of two workloads. An engine's techniques that are not measured have the mean factor of the others. Takes
/// about 0.1 s, and no more than 0.2 s unless one search takes longer. Errors: `probe_error` in the median.
[[nodiscard]] Calibration probe(const std::stop_token& stop = {});

/// Median error of seconds by the costs of a probe, relative; measured in probe.md.
inline constexpr double probe_error = 0.25;

/// Probes this machine if stored_calibration() has none of this machine and program, and writes the costs where it finds them. If they
/// cannot be written, nothing is measured: the built-in costs stay in use, so that a question keeps its answer.
void probe_once(const std::stop_token& stop = {});

}  // namespace detp::validate
