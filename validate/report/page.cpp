#include <fmt/format.h>

#include "detp/validate/picture/bitmap.hpp"
#include "detp/validate/picture/labels.hpp"
#include "page_assets.hpp"
#include "parts.hpp"
#include "report.hpp"

namespace detp::validate {
namespace {

/// JSON as text that ends no element and begins no comment.
std::string json_in_html(const Json& report) {
  std::string safe;
  for (const char c : report.dump(1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

/// A digest in hexadecimal digits, as a content security policy has it.
std::string base64_of_hex(std::string_view hex) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(16 * digits.find(hex[i]) + digits.find(hex[i + 1]));
  return base64(bytes);
}

/// A figure that is read first: what it is, the figure, and the rest.
std::string card(const std::string& what, const std::string& figure, const std::string& rest) {
  return fmt::format("<div class=\"card\"><dt>{}</dt><dd><strong>{}</strong> <span>{}</span></dd></div>\n",
                     xml_text(what), xml_text(figure), xml_text(rest));
}

std::string technique_card(const Json& answer) {
  if (words(answer, "technique").empty()) return card("Fastest technique", "not known", "stopped before the choice");
  std::string rest = parameter_words(answer);
  if (const auto threads = number(answer, "threads"))
    rest += fmt::format("{}{:.0f} thread{}", rest.empty() ? "" : "; ", *threads, *threads == 1 ? "" : "s");
  return card("Fastest technique", words(answer, "technique"), rest);
}

std::string seconds_card(const Json& answer) {
  const std::string predicted = shown_seconds(answer, "predicted_seconds", "predicted_seconds_error");
  const std::string measured = shown_seconds(answer, "measured_seconds", "measured_spread");
  if (!measured.empty())
    return card("Time of a run, measured", measured, predicted.empty() ? "" : "predicted: " + predicted);
  return predicted.empty() ? "" : card("Time of a run, predicted", predicted, "not measured");
}

std::string accuracy_card(const Json& answer) {
  const Json& accuracy = list(answer, "accuracy");
  const auto seconds = number(accuracy, "seconds");
  const std::string target = words(accuracy, "target");
  if (!seconds) return {};
  const Json& interval = list(accuracy, "seconds_interval");
  std::string rest;
  if (interval.size() == 2)
    rest =
        fmt::format("{} to {}; ", seconds_label(interval[0].get<double>()), seconds_label(interval[1].get<double>()));
  if (const auto photons = number(accuracy, "photons"); photons && *photons > 0)
    rest += count_words(*photons) + " photon paths; ";
  rest += words(accuracy, "estimator");
  if (const Json& error = list(accuracy, "error_interval"); error.size() == 2)
    rest += fmt::format("; total error (noise and bias) {} to {}, 95 %", percent_label(error[0].get<double>()),
                        percent_label(error[1].get<double>()));
  if (accuracy.value("reached", true)) return card(fmt::format("{} costs", target), seconds_label(*seconds), rest);
  return card(fmt::format("{} is out of reach; nearest", target), shown(accuracy, "error", percent_label, "?"),
              fmt::format("in {}; {}", seconds_label(*seconds), words(accuracy, "estimator")));
}

/// The scene in the colours of its irradiance.
std::string picture_html(const Json& report, std::string_view png) {
  if (png.empty()) return {};
  const Json& run = answer_of(report, "picture");
  return fmt::format(
      "<p><img alt=\"{} in the colours of its irradiance, and of its relative standard error\" "
      "src=\"data:image/png;base64,{}\"><br>Light on the surface, by {} {}.</p>\n",
      xml_text(words(list(report, "inputs"), "scene")), base64(png), shown(list(run, "inputs"), "rays", count_words),
      words(list(run, "inputs"), "field") == "photons" ? "pieces of photon paths" : "rays");
}

/// Technique, parameters, seconds, and what the accuracy costs: the top of the page.
std::string answer_section(const Json& report, std::string_view picture) {
  const Json& answer = list(report, "answer");
  std::string html = fmt::format("<header>\n<h1>Density estimation in <bdi>{}</bdi></h1>\n",
                                 xml_text(words(list(report, "inputs"), "scene")));
  if (report.value("stopped", false))
    html +=
        "<p class=\"warning\" role=\"note\"><strong>Partial.</strong> The work was stopped; the page has what was "
        "known then.</p>\n";
  html += "<dl class=\"cards\">\n" + technique_card(answer) + seconds_card(answer) + accuracy_card(answer) + "</dl>\n";
  html += fmt::format("<p class=\"answer\">{}</p>\n", xml_text(words(answer, "text")));
  for (const Json& warning : list(report, "warnings"))
    if (warning.is_string())
      html += fmt::format("<p class=\"warning\" role=\"note\"><strong>Warning:</strong> {}</p>\n",
                          xml_text(warning.get<std::string>()));
  return html + picture_html(report, picture) + "</header>\n";
}

/// Machine, version, seed; each part's command and seconds.
std::string origin_section(const Json& report) {
  const Json& origin = list(report, "provenance");
  const Json& inputs = list(answer_of(report, "choice"), "inputs");
  Rows facts{{"what", "value"}};
  const auto add = [&](const std::string& what, const std::string& value) {
    if (!value.empty()) facts.cells.push_back({what, value});
  };
  const auto whole = [](double number) { return fmt::format("{:.0f}", number); };
  const auto length = [](double number) { return fmt::format("{:.4g}", number); };
  add("processor", words(origin, "cpu"));
  add("threads", shown(origin, "threads", whole));
  add("program", fmt::format("{} {}", words(origin, "program"), words(origin, "version")));
  add("seed", shown(origin, "seed", whole));
  add("unit costs", words(answer_of(report, "choice"), "unit_costs"));
  add("rays", shown(inputs, "rays", count_words));
  add("kind of rays", words(inputs, "field"));
  add("discs", shown(inputs, "samples", count_words));
  add("disc radius d", shown(inputs, "disc_radius", length));
  add("distance between samples", shown(inputs, "sample_distance", length));
  add("dimension D of the samples", shown(inputs, "dimension", length));
  Rows parts{{"part", "command", "time", "forecast"}};
  for (const Json& part : list(report, "parts"))
    parts.cells.push_back({words(part, "name"), words(part, "command"),
                           shown(part, "seconds", seconds_label, "not run"),
                           shown(part, "forecast_seconds", seconds_label)});
  std::string body = table_html("machine and inputs", facts) + table_html("parts of this page", parts);
  if (const auto seconds = number(report, "seconds"))
    body += paragraph(
        fmt::format("The page took {}; the forecast was {}. It has the whole answer as JSON, in the element with the "
                    "id \u201canswer\u201d.",
                    seconds_label(*seconds), shown(report, "forecast_seconds", seconds_label, "not made")));
  return section_html("How this was made", body);
}

}  // namespace

std::string page_html(const Json& given, std::string_view picture) {
  // Names of files may be no valid UTF-8; what is printed as JSON is what is shown.
  const Json report = Json::parse(given.dump(-1, ' ', false, Json::error_handler_t::replace));
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'sha256-{}'; script-src "
      "'sha256-{}'; "
      "img-src data:; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" "
      "content=\"light dark\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>detp: {}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n",
      base64_of_hex(page_css_digest), base64_of_hex(page_js_digest), xml_text(words(list(report, "inputs"), "scene")),
      page_css);
  html += answer_section(report, picture);
  for (const auto section : {choice_section, map_section, accuracy_section, comparison_section, verdict_section,
                             effects_section, origin_section})
    html += section(report);
  return html + fmt::format(
                    "</main>\n<script type=\"application/json\" "
                    "id=\"answer\">{}</script>\n<script>{}</script>\n</body>\n</html>\n",
                    json_in_html(report), page_js);
}

}  // namespace detp::validate
