#pragma once

#include <stop_token>

#include "calibrate.hpp"

/// Costs of a machine that was not calibrated.
namespace detp::validate {

/// The built-in costs of each technique and engine, times two factors: one for sorting and building, one for the search. They are the measured over the
/// predicted seconds of two short searches (of a box tree also of a larger one), on one thread, in processor time: the median of rounds, until 0.2 s have
/// passed, and their geometric mean. Errors: `probe_error` in the median.
[[nodiscard]] Calibration probe(const std::stop_token& stop = {});

/// Median error of seconds by the costs of a probe, relative; measured in probe.md.
inline constexpr double probe_error = 0.25;

/// Probes this machine if stored_calibration() has none of this machine and program, and writes the costs where it finds them. If they
/// cannot be written, nothing is measured: the built-in costs stay in use, so that a question keeps its answer.
void probe_once(const std::stop_token& stop = {});

}  // namespace detp::validate
