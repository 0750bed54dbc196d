#include "page.hpp"

#include <fmt/format.h>

#include "page_assets.hpp"
#include "sections.hpp"

namespace detp::validate {
namespace {

/// JSON as text that ends no element and begins no comment.
std::string json_in_html(const ReportJson& report) {
  std::string safe;
  for (const char c : report.dump(1, ' ', false, ReportJson::error_handler_t::replace)) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

/// The digest of 64 hexadecimal digits in base 64, as a content security policy has it.
std::string base64_of_hex(std::string_view hex) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr std::string_view hex_digits = "0123456789abcdef";
  std::string bits;
  for (const char c : hex) {
    const std::size_t value = hex_digits.find(c);
    for (int bit = 3; bit >= 0; --bit) bits += (value >> bit & 1) != 0 ? '1' : '0';
  }
  std::string text;
  for (std::size_t i = 0; i < bits.size(); i += 6) {
    std::size_t value = 0;
    for (std::size_t j = i; j < i + 6; ++j) value = 2 * value + (j < bits.size() && bits[j] == '1' ? 1 : 0);
    text += digits[value];
  }
  text.append((4 - text.size() % 4) % 4, '=');
  return text;
}

}  // namespace

std::string page_html(const ReportJson& given) {
  // Names of files may be no valid UTF-8; what is printed as JSON is what is shown.
  const ReportJson report = ReportJson::parse(given.dump(-1, ' ', false, ReportJson::error_handler_t::replace));
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
  for (const auto section : {answer_section, choice_section, map_section, accuracy_section, comparison_section,
                             verdict_section, effects_section, origin_section})
    html += section(report);
  return html + fmt::format(
                    "</main>\n<script type=\"application/json\" "
                    "id=\"answer\">{}</script>\n<script>{}</script>\n</body>\n</html>\n",
                    json_in_html(report), page_js);
}

}  // namespace detp::validate
