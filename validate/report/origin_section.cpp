#include <fmt/format.h>

#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"
#include "sections.hpp"

namespace detp::validate {

std::string origin_section(const ReportJson& report) {
  const ReportJson& origin = list(report, "provenance");
  const ReportJson& inputs = list(answer_of(report, "choice"), "inputs");
  Rows facts{.head = {"what", "value"}, .cells = {}};
  const auto add = [&](const std::string& what, const std::string& value) {
    if (!value.empty()) facts.cells.push_back({what, value});
  };
  const auto count = [&](const char* key) { return number(inputs, key) ? count_words(*number(inputs, key)) : ""; };
  const auto length = [&](const char* key) {
    return number(inputs, key) ? fmt::format("{:.4g}", *number(inputs, key)) : "";
  };
  add("processor", words(origin, "cpu"));
  add("threads", number(origin, "threads") ? fmt::format("{:.0f}", *number(origin, "threads")) : "");
  add("program", fmt::format("{} {}", words(origin, "program"), words(origin, "version")));
  add("seed", number(origin, "seed") ? fmt::format("{:.0f}", *number(origin, "seed")) : "");
  add("unit costs", words(answer_of(report, "choice"), "unit_costs"));
  add("rays", count("rays"));
  add("kind of rays", words(inputs, "field"));
  add("discs", count("samples"));
  add("disc radius d", length("disc_radius"));
  add("distance between samples", length("sample_distance"));
  add("dimension D of the samples", length("dimension"));
  Rows parts{.head = {"part", "command", "time", "forecast"}, .cells = {}};
  for (const ReportJson& part : list(report, "parts")) {
    const auto seconds = number(part, "seconds");
    const auto forecast = number(part, "forecast_seconds");
    parts.cells.push_back({words(part, "name"), words(part, "command"), seconds ? seconds_label(*seconds) : "not run",
                           forecast ? seconds_label(*forecast) : ""});
  }
  std::string body = table_html("machine and inputs", facts) + table_html("parts of this page", parts);
  if (const auto seconds = number(report, "seconds"))
    body += paragraph(fmt::format(
        "The page took {}; the forecast was {}. It has the whole answer as JSON, in the element with the "
        "id \u201canswer\u201d.",
        seconds_label(*seconds),
        number(report, "forecast_seconds") ? seconds_label(*number(report, "forecast_seconds")) : "not made"));
  return section_html("How this was made", body);
}

}  // namespace detp::validate
