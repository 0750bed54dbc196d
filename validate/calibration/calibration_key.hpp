#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

/// The machine and program to which stored costs and stored choices belong.
namespace detp::validate {

/// What measured costs, and choices made with them, depend on. They are only used where all of this is the same.
struct CalibrationKey {
  std::string cpu;              ///< model name
  std::string instruction_set;  ///< of the float kernels
  std::string caches;           ///< bytes of the levels 1 to 3
  int threads = 0;              ///< that the machine runs at once
  std::string compiler;
  int cost_model = 0;  ///< version of the terms that are fitted

  bool operator==(const CalibrationKey&) const = default;
};

/// The key of this program on this machine.
[[nodiscard]] CalibrationKey this_machine();

/// The first difference in words, as "its cpu is A, here it is B"; empty if the keys are equal.
[[nodiscard]] std::string difference(const CalibrationKey& stored, const CalibrationKey& here);

[[nodiscard]] nlohmann::ordered_json to_json(const CalibrationKey& key);

/// Throws nlohmann::json::exception if a value is missing or of another type.
[[nodiscard]] CalibrationKey key_of(const nlohmann::ordered_json& json);

}  // namespace detp::validate
