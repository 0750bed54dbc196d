#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "calibration.hpp"

/// The unit costs of a question: given by the user, calibrated on this machine, probed, or built in.
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

/// Which unit costs a question uses.
struct CostRequest {
  std::optional<UnitCosts> given = {};  ///< of all techniques, on one thread; instead of a calibration
  /// "none": the built-in costs; "auto": those of stored_calibration(), else the built-in ones; else the file of a calibration
  std::string calibration = "auto";
  bool may_probe = true;  ///< of "auto": a machine without a stored calibration is probed before (probe_once)
};

struct CostsInUse {
  CostTable simd;
  CostTable plain;
  std::string origin;  ///< "of each operation: built in, ..."
  bool built_in = false;
  double relative_error = 0;  ///< standard error of seconds by these costs, relative to them; 0: not known
  std::string doubt = {};     ///< why seconds by these costs are doubtful; mostly empty

  [[nodiscard]] const CostTable& of(Engine engine) const { return engine == Engine::plain ? plain : simd; }
};

/// Told why a stored calibration is not used.
using Notice = std::function<void(const std::string&)>;

/// Throws std::invalid_argument for a named calibration of another machine or program, and sim::FileError for a named file that is no
/// calibration.
[[nodiscard]] CostsInUse costs_in_use(const CostRequest& request, const Notice& notice = {});

/// The unit costs as JSON, under their symbols.
[[nodiscard]] nlohmann::ordered_json to_json(const UnitCosts& costs);

/// The same for each exact technique, under its name; without names if all techniques have the same costs. Costs of 0
/// are left out.
[[nodiscard]] nlohmann::ordered_json to_json(const CostTable& costs);

}  // namespace detp::validate
