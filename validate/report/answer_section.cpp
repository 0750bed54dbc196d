#include <fmt/format.h>

#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"
#include "sections.hpp"

namespace detp::validate {
namespace {

/// A figure that is read first: what it is, the figure, and the rest.
std::string card(const std::string& what, const std::string& figure, const std::string& rest) {
  return fmt::format("<div class=\"card\"><dt>{}</dt><dd><strong>{}</strong> <span>{}</span></dd></div>\n",
                     xml_text(what), xml_text(figure), xml_text(rest));
}

std::string technique_card(const ReportJson& answer) {
  if (words(answer, "technique").empty()) return card("Fastest technique", "not known", "stopped before the choice");
  std::string rest = parameter_words(answer);
  if (const auto threads = number(answer, "threads"))
    rest += fmt::format("{}{:.0f} thread{}", rest.empty() ? "" : "; ", *threads, *threads == 1 ? "" : "s");
  return card("Fastest technique", words(answer, "technique"), rest);
}

std::string seconds_card(const ReportJson& answer) {
  const auto predicted = number(answer, "predicted_seconds");
  const auto measured = number(answer, "measured_seconds");
  if (!predicted && !measured) return {};
  const std::string prediction =
      predicted ? "predicted: " + seconds_words(*predicted, number(answer, "predicted_seconds_error")) : "";
  if (measured)
    return card("Time of a run, measured", seconds_words(*measured, number(answer, "measured_spread")), prediction);
  return card("Time of a run, predicted", seconds_words(*predicted, number(answer, "predicted_seconds_error")),
              "not measured");
}

std::string accuracy_card(const ReportJson& answer) {
  const ReportJson& accuracy = list(answer, "accuracy");
  const auto seconds = number(accuracy, "seconds");
  const std::string target = words(accuracy, "target");
  if (!seconds) return {};
  const ReportJson& interval = list(accuracy, "seconds_interval");
  std::string rest;
  if (interval.size() == 2)
    rest =
        fmt::format("{} to {}; ", seconds_label(interval[0].get<double>()), seconds_label(interval[1].get<double>()));
  if (const auto photons = number(accuracy, "photons"); photons && *photons > 0)
    rest += count_words(*photons) + " photon paths; ";
  rest += words(accuracy, "estimator");
  if (const ReportJson& error = list(accuracy, "error_interval"); error.size() == 2)
    rest += fmt::format("; total error (noise and bias) {} to {}, 95 %", percent_label(error[0].get<double>()),
                        percent_label(error[1].get<double>()));
  if (accuracy.value("reached", true)) return card(fmt::format("{} costs", target), seconds_label(*seconds), rest);
  return card(fmt::format("{} is out of reach; nearest", target),
              number(accuracy, "error") ? percent_label(*number(accuracy, "error")) : "?",
              fmt::format("in {}; {}", seconds_label(*seconds), words(accuracy, "estimator")));
}

}  // namespace

std::string answer_section(const ReportJson& report) {
  const ReportJson& answer = list(report, "answer");
  std::string html = fmt::format("<header>\n<h1>Density estimation in <bdi>{}</bdi></h1>\n",
                                 xml_text(words(list(report, "inputs"), "scene")));
  if (report.value("stopped", false))
    html +=
        "<p class=\"warning\" role=\"note\"><strong>Partial.</strong> The work was stopped; the page has what was "
        "known then.</p>\n";
  html += "<dl class=\"cards\">\n" + technique_card(answer) + seconds_card(answer) + accuracy_card(answer) + "</dl>\n";
  html += fmt::format("<p class=\"answer\">{}</p>\n", xml_text(words(answer, "text")));
  for (const ReportJson& warning : list(report, "warnings"))
    if (warning.is_string())
      html += fmt::format("<p class=\"warning\" role=\"note\"><strong>Warning:</strong> {}</p>\n",
                          xml_text(warning.get<std::string>()));
  return html + "</header>\n";
}

}  // namespace detp::validate
