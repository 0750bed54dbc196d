#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "detp/validate/base/json.hpp"

/// Files with a checksum, altered on purpose.
namespace detp::support {

/// The text of a calibration with a checksum that fits.
inline std::string sealed_calibration(nlohmann::json json) {
  nlohmann::json members;
  for (const char* name :
       {"key", "date", "left_out_median_error", "processor_share", "relative_errors", "costs", "threads"})
    members[name] = json.at(name);
  json["checksum"] = validate::checksum(members);
  return json.dump();
}

/// The text of a checkpoint with a checksum that fits.
inline std::string sealed_checkpoint(nlohmann::json json) {
  json["checksum"] = validate::checksum(json.at("work"), json.at("key"), json.at("state"));
  return json.dump();
}

}  // namespace detp::support
