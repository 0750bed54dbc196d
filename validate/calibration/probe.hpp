#pragma once

#include <stop_token>

#include "calibrate.hpp"

/// Costs of a machine that was not calibrated.
namespace detp::validate {

/// The built-in costs of each technique and engine, times two factors: one for sorting and building, one for the search. They are the measured over the
/// predicted seconds of two short searches (of a box tree also of a larger one), on one thread, in processor time: the least of rounds, until 0.2 s have
/// passed, and the geometric mean of the searches.
[[nodiscard]] Calibration probe(const std::stop_token& stop = {});

/// Relative error of seconds by the costs of a probe that is taken for the median. Not well known: five probes of one machine (AMD EPYC, Zen 5) predicted
/// one search down a box tree with errors of 1 to 31 %, 21 % in the median.
inline constexpr double probe_error = 0.25;

/// Probes this machine if stored_calibration() has none of this machine and program, and writes the costs where it finds them. If they
/// cannot be written, nothing is measured, and if the probe fails, as where memory is short, nothing is said: the built-in costs stay in use, so that a question keeps its answer.
void probe_once(const std::stop_token& stop = {});

}  // namespace detp::validate
