#include "envelope.hpp"

#include "detp/validate/calibration/calibration_file.hpp"

namespace detp::cli {

Json envelope(const std::string& command, const CommonOptions& common, int threads, Result& result) {
  const std::string& schema = result.schema.empty() ? command : result.schema;
  Json json{{"schema", {{"name", "detp." + schema}, {"version", 1}}}, {"inputs", std::move(result.inputs)}};
  json.update(result.json);
  json["provenance"] = {{"program", "detp"},
                        {"version", DETP_VERSION},
                        {"seed", common.seed},
                        {"threads", threads},
                        {"cpu", validate::this_machine().cpu}};
  if (common.ranks != nullptr) json["provenance"]["ranks"] = common.ranks->count();
  return json;
}

}  // namespace detp::cli
