#include <doctest/doctest.h>

#include <map>
#include <random>
#include <regex>
#include <set>

#include "detp/validate/report/report.hpp"
#include "support/attempts.hpp"
#include "support/command.hpp"
#include "support/xml.hpp"

namespace detp::support {
namespace {

const std::string small_report = "report @cornell --samples 300 --rays 2000 --quick -o ";

/// Replaces each text in the answer by what `text_of` makes of it, except names that decide what is drawn.
template <class TextOf>
void replace_texts(validate::Json& json, const TextOf& text_of, const std::string& key = "") {
  static const std::set<std::string> kept{"name", "technique", "estimator", "verdict"};
  if (json.is_structured()) {
    for (auto& [inner, value] : json.items()) replace_texts(value, text_of, json.is_object() ? inner : key);
  } else if (json.is_string() && !kept.contains(key) && !json.get<std::string>().empty()) {
    json = text_of(json.get<std::string>());
  }
}

/// The page's elements before its scripts, with the names of their attributes, without text and values; without lines and
/// labels of axes, whose number depends on the room that names leave.
std::string structure_of(const std::string& html) {
  std::string structure;
  char quote = 0;
  bool inside = false;
  for (const char c : html.substr(0, html.find("<script"))) {
    if (!inside) {
      inside = c == '<';
      if (inside) structure += c;
    } else if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else {
      structure += c;
      inside = c != '>';
    }
  }
  static const std::regex axes("<line[^>]*>|<text[^>]*>|</text>");
  return std::regex_replace(structure, axes, "");
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("a report is one page with the answer, its parts and their commands; stdout has the same JSON" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string page = folder.path("report.html");
    const Json json = result_of(small_report + page);
    CHECK(json["schema"]["name"] == "detp.report");
    CHECK(json["stopped"] == false);
    CHECK(json["answer"]["technique"].is_string());
    CHECK(json["answer"]["accuracy"]["target"] == "5 % noise");
    std::vector<std::string> names;
    for (const Json& part : json["parts"]) {
      names.push_back(part["name"]);
      CHECK(part["command"].get<std::string>().starts_with("detp "));
      CHECK(part["answer"]["schema"]["version"] == 1);
      CHECK(part["answer"]["stopped"] == false);
    }
    CHECK(names == std::vector<std::string>{"scene", "choice", "picture", "accuracy", "map", "verdicts"});
    const std::string html = content_of(page);
    CHECK(html.size() < 900'000);
    CHECK(html.starts_with("<!doctype html>"));
    for (const char* part : {"<html lang=\"en\">", "Content-Security-Policy", "default-src 'none'", "<h1>", "<table>"})
      CHECK_MESSAGE(html.find(part) != std::string::npos, part);
    for (const char* part : {"href=\"http", "src=\"h", "@import", "url(", "\"nan", "\"inf"})
      CHECK_MESSAGE(html.find(part) == std::string::npos, part);
    CHECK(html.find("src=\"data:image/png;base64,iVBOR") != std::string::npos);
    const std::string start = "id=\"answer\">";
    const std::size_t from = html.find(start) + start.size();
    const Json inside = Json::parse(html.substr(from, html.find("</script>", from) - from));
    CHECK(inside["parts"].size() == json["parts"].size());
    CHECK(inside["answer"] == json["answer"]);
    // A part's command gives the part's answer.
    const std::string command = json["parts"][5]["command"];
    CHECK(result_of(command.substr(5))["claims"].size() == json["parts"][5]["answer"]["claims"].size());
  }

  TEST_CASE("a report that is stopped has what was known, and says so; a scene without light has no accuracy" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string page = folder.path("report.html");
    CHECK(in_attempts(3, [&] {
      const Finished stopped = detp("report @tree --time-limit 0.5 -o " + page);
      CHECK(stopped.code == 3);
      return stopped.seconds < 5;
    }));
    const std::string html = content_of(page);
    CHECK(html.find("<strong>Partial.</strong>") != std::string::npos);
    CHECK(html.find("Not made: stopped before it.") != std::string::npos);
    const Finished dark = detp("report @uniform --samples 300 --rays 1000 --quick -o " + page);
    CHECK(dark.code == 0);
    CHECK(content_of(page).find("@uniform has no triangles") != std::string::npos);
  }

  TEST_CASE("bad input is refused before any work, and no page is left") {
    const ScratchFolder folder;
    const std::string page = " -o " + folder.path("report.html");
    check_refused({{"report @cornell", "-o FILE.html"},
                   {"report" + page, "SCENE"},
                   {"report @cornell --target-error 5% --target-noise 5%" + page, "one of"},
                   {"report @cornell --target-noise 200%" + page, "target"},
                   {"report nothing.obj" + page, "nothing.obj"},
                   {"report @cornell -o /nowhere/x.html", "/nowhere"}});
    CHECK(folder.entries() == 0);
  }

  TEST_CASE("no text of the answer can change the page's elements" * doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string page = folder.path("report.html");
    const Finished finished = detp(small_report + page + " --format json");
    const auto answer = validate::Json::parse(finished.out);
    const std::vector<std::string> pieces{
        "<",   ">",        "\"",  "'",    "&",     "</script>", "<script>alert(1)</script>",
        "-->", "<!--",     "]]>", "\\",   "\x01",  "\xff\xfe",  "\u2028",
        "\0x", "</style>", "`",   "${x}", "&#60;", "\u202e",    "<svg onload=alert(1)>"};
    std::mt19937_64 random(1);
    for (int i = 0; i < 100; ++i) {
      // Equal texts stay equal and others differ, for they decide what is drawn: parameters of candidates can be texts.
      std::map<std::string, std::size_t> numbers;
      const auto number_of = [&](const std::string& text) {
        return numbers.try_emplace(text, numbers.size()).first->second;
      };
      std::vector<std::string> hostile_texts;
      validate::Json hostile = answer;
      replace_texts(hostile, [&](const std::string& original) {
        const std::size_t number = number_of(original);
        if (number == hostile_texts.size()) {
          std::string text;
          for (std::size_t n = 1 + random() % 4; n > 0; --n) text += pieces[random() % pieces.size()];
          hostile_texts.push_back(text + std::to_string(number));
        }
        return hostile_texts[number];
      });
      const std::string html = validate::page_html(hostile);
      validate::Json harmless = answer;
      replace_texts(harmless, [&](const std::string& original) { return "x" + std::to_string(number_of(original)); });
      const std::string expected = structure_of(validate::page_html(harmless));
      const bool same = structure_of(html) == expected;
      CHECK(same);
      CHECK(count_of(html, "<script") == 2);
      CHECK(count_of(html, "</script>") == 2);
    }
  }

  TEST_CASE("an empty answer makes a page, too") {
    const std::string html = validate::page_html(validate::Json::object());
    CHECK(count_of(html, "<h2>") == 7);
    const bool same = html == validate::page_html(validate::Json::object());
    CHECK(same);
  }
}

}  // namespace detp::support
