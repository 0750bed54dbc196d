#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/validate/base/fields.hpp"

/// What `detp report` does: asks other commands about a scene, and makes a page of their answers.
namespace detp::validate {

/// Numbers with units are words of a command line: "4%", "0.02".
struct ReportRequest {
  std::string scene;
  std::optional<double> rays = {};
  std::optional<std::string> disc_radius = {};
  std::optional<double> samples = {};
  std::optional<std::string> lights = {};
  std::optional<std::string> up = {};
  bool front_facing = false;
  std::optional<std::string> target_error = {};
  std::optional<std::string> target_noise = {};  ///< 5% without either
  bool quick = false;
  std::vector<std::string> common = {};  ///< words for every part: --seed, --threads
};

/// A command, and its answer.
struct ReportPart {
  std::string name;
  std::vector<std::string> words;  ///< of the command line
  std::optional<double> forecast_seconds = {};
  bool may_fail = false;  ///< the scene may have no such answer
  double seconds = 0;
  Json answer = left_out();
  std::string not_made = {};  ///< why there is no answer

  /// As a shell takes it: "detp scene @tree".
  [[nodiscard]] std::string command() const;
};

/// In the words of a command: the file of its picture, which page_html takes as bytes.
inline constexpr std::string_view picture_name = "picture.png";

/// The JSON that a command's words answer with. May throw std::invalid_argument, sim::Stopped.
using Ask = std::function<Json(const std::vector<std::string>& words)>;

/// The report as JSON: `inputs`, `answer`, `warnings`, `parts` (scene, choice, picture, accuracy, map, verdicts, each with the answer of its command),
/// `seconds`, `forecast_seconds`, `stopped`. A stop request ends it with the parts that are made. Throws as `ask`.
[[nodiscard]] Json answer(const ReportRequest& request, const Ask& ask, const std::stop_token& stop = {},
                          const sim::ReportPhase& progress = {});

/// The fields of a part; its columns are those of the table.
[[nodiscard]] const Fields<ReportPart>& part_fields();
/// What the lists of fields say: of the inputs, and of a part.
[[nodiscard]] std::vector<FieldText> describe_report();

/// The report as HTML: complete, with nothing outside of it. All text of the report is escaped, and a content security policy allows only the
/// page's own style and script. The same report gives the same bytes. `picture`: PNG of the part `picture`; empty: none. Throws std::invalid_argument if the report has numbers where a
/// chart needs others (not finite).
[[nodiscard]] std::string page_html(const Json& report, std::string_view picture = {});

}  // namespace detp::validate
