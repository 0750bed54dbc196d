#include "calibration_key_json.hpp"

#include <nlohmann/json.hpp>

namespace detp::validate {

nlohmann::ordered_json to_json(const CalibrationKey& key) {
  return {{"cpu", key.cpu},           {"instruction_set", key.instruction_set},
          {"caches", key.caches},     {"threads", key.threads},
          {"compiler", key.compiler}, {"cost_model", key.cost_model}};
}

CalibrationKey key_of(const nlohmann::ordered_json& json) {
  return {.cpu = json.at("cpu"),
          .instruction_set = json.at("instruction_set"),
          .caches = json.at("caches"),
          .threads = json.at("threads"),
          .compiler = json.at("compiler"),
          .cost_model = json.at("cost_model")};
}

}  // namespace detp::validate
