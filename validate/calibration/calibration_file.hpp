#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "calibrate.hpp"
#include "calibration.hpp"

/// Calibrations on disc, and the unit costs of a question: given by the user, calibrated on this machine, probed, or built in.
namespace detp::validate {

/// detp/calibration.json in $XDG_CACHE_HOME, or in ~/.cache if that is not set to an absolute path; empty if there is
/// no home either.
[[nodiscard]] std::string default_calibration_path();

/// detp/probe.json beside it.
[[nodiscard]] std::string probe_path();

/// The content of a calibration's file: the key of this machine, today's date, the costs and their errors, a checksum.
[[nodiscard]] nlohmann::ordered_json calibration_json(const Calibration& calibration);
[[nodiscard]] std::string calibration_text(const Calibration& calibration);

/// Writes the file, and its folder if necessary. Throws sim::FileError.
void write_calibration(const std::string& path, const Calibration& calibration);

/// The same, but a doubtful calibration does not replace a better one of this machine and program, and none replaces another
/// program's file. Returns why it was not written; "" if it was.
std::string save_calibration(const std::string& path, const Calibration& calibration);

/// Throws sim::FileError if the file cannot be read, if it is not a calibration, or if an older or newer program wrote it.
[[nodiscard]] Calibration read_calibration(const std::string& path);

/// The calibration in the file, if there is one of this machine and program. Else nullopt, and in *why_not, unless null, the
/// reason with the path; "" if there is no such file.
[[nodiscard]] std::optional<Calibration> find_calibration(const std::string& path, std::string* why_not = nullptr);

/// The one that detp calibrate stored, else the one of a probe (probe_once); `why_not` is that of the first.
[[nodiscard]] std::optional<Calibration> stored_calibration(std::string* why_not = nullptr);

/// The stored costs of this machine, for PlanOptions::costs; the built-in ones if there are none that can be used.
[[nodiscard]] CostTable stored_unit_costs(Engine engine = Engine::simd);

/// The text as read_calibration reads it; `path` is for messages.
[[nodiscard]] Calibration parse_calibration(const std::string& text, const std::string& path);

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
