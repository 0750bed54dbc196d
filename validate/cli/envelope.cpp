#include "envelope.hpp"

#include <fmt/format.h>

#include <sstream>

#include "detp/validate/calibration/calibration_file.hpp"

namespace detp::cli {
namespace {

Json given_options(const CLI::App& command) {
  Json given = Json::object();
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0) given[option->get_single_name()] = fmt::format("{}", fmt::join(option->results(), ","));
  return given;
}

std::string after(const sim::Progress& progress) {
  return fmt::format("after {} of {} {}", progress.done, progress.of, progress.unit);
}

/// The additional columns have the same values in every row.
std::string with_columns(const std::string& csv, const std::string& names, const std::string& fields) {
  if (csv.empty()) return names + "\n" + fields + "\n";
  std::istringstream lines(csv);
  std::string wider;
  for (std::string line; std::getline(lines, line);) {
    wider += line + "," + (wider.empty() ? names : fields) + "\n";
  }
  return wider;
}

}  // namespace

Result stopped_result(const CLI::App& command, const sim::Stopped& stopped) {
  Result result;
  result.inputs = given_options(command);
  result.json = {{"stopped_while", stopped.what()}};
  result.text = fmt::format("{}; nothing is known yet\n", stopped.what());
  result.stopped = stopped.progress();
  return result;
}

void mark_stopped(Result& result, double seconds, const Screen& screen) {
  const sim::Progress& progress = *result.stopped;
  const bool known = progress.of > 0;
  result.code = ExitCode::stopped;
  if (known) result.json["stopped_after"] = {{"done", progress.done}, {"of", progress.of}, {"unit", progress.unit}};
  result.json["stop_seconds"] = seconds;
  const std::string line = fmt::format("stopped   {}what follows is partial (stopped within {:.2g} s)",
                                       known ? after(progress) + ": " : "", seconds);
  result.text = styled(screen, Style::doubtful, line) + "\n" + result.text;
  result.csv = with_columns(result.csv, "stopped_after,stopped_of,stopped_unit",
                            known ? fmt::format("{},{},{}", progress.done, progress.of, progress.unit) : ",,");
}

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
