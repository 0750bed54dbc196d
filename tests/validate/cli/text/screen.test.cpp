#include "detp/validate/cli/text/screen.hpp"
#include "support/terminal.hpp"

#include <doctest/doctest.h>

namespace detp::support {
namespace {

using cli::Screen;
using cli::Style;

constexpr const char* small_workload = "--samples 1000 --rays 2000 --disc-radius 0.02 --scene-side 2";

std::size_t widest_line(const std::string& text) {
  std::size_t widest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, cli::columns_of(line));
  return widest;
}

const std::vector<cli::TextBlock> blocks{{{"", "1", "22"}}, {{"a", "bb", "c"}}, {{"A", "BBBB", "C"}}};

}  // namespace

TEST_SUITE("identities") {
  TEST_CASE("a text takes a column for each character, none for colours") {
    CHECK(cli::columns_of("") == 0);
    CHECK(cli::columns_of("grid") == 4);
    CHECK(cli::columns_of("3 ± 1") == 5);
    CHECK(cli::columns_of(cli::styled(Screen{.colour = true}, Style::good, "grid")) == 4);
  }

  TEST_CASE("a style is a code before and after the text where there are colours, and nothing elsewhere") {
    CHECK(cli::styled(Screen{}, Style::bad, "refuted") == "refuted");
    CHECK(cli::styled(Screen{.colour = true}, Style::bad, "refuted") == "\033[31mrefuted\033[0m");
    CHECK(cli::styled(Screen{.colour = true}, Style::plain, "refuted") == "refuted");
  }

  TEST_CASE("only the codes of styles, and only where there are colours, are not escaped") {
    const std::string text = cli::styled(Screen{.colour = true}, Style::good, "a") + "\n\033[2J\xff";
    CHECK(cli::safe_text(text, true) == "\033[32ma\033[0m\n\\x1b[2J\\xff");
    CHECK(cli::safe_text(text) == "\\x1b[32ma\\x1b[0m\n\\x1b[2J\\xff");
  }

  TEST_CASE("a paragraph is broken at spaces; a word that is too long stays whole") {
    CHECK(cli::wrapped("one two three", 120) == "one two three\n");
    CHECK(cli::wrapped("one two three", 7) == "one two\nthree\n");
    CHECK(cli::wrapped("one two three", 8, 4) == "one two\n    three\n");
    CHECK(cli::wrapped("a  incomprehensible b", 5) == "a\nincomprehensible\nb\n");
    CHECK(cli::wrapped("one two\nthree\n", 6, 1) == "one\n two\nthree\n");
    CHECK(cli::wrapped("", 10) == "\n");
  }
}

TEST_SUITE("end to end") {
  TEST_CASE("on a terminal text is no wider than it, and what was left out is named") {
    const std::string line = std::string("choose ") + small_workload + " --verbose";
    CHECK(widest_line(shown_on_terminal(std::string("choose ") + small_workload, 60)) <= 60);
    const std::string narrow = shown_on_terminal(line, 60);
    CHECK(widest_line(narrow) <= 60);
    CHECK(narrow.find("left out of 60 columns") != std::string::npos);
    const std::string wide = shown_on_terminal(line, 200);
    CHECK(wide.find("left out") == std::string::npos);
    CHECK(widest_line(wide) > 60);
    CHECK(widest_line(detp("help choose").out) <= 120);
    CHECK(widest_line(shown_on_terminal("help choose", 80)) <= 80);
  }

  TEST_CASE("colours are shown on a terminal, unless NO_COLOR or --color never; elsewhere with --color always alone") {
    const std::string line = std::string("choose ") + small_workload;
    const auto coloured = [](const std::string& text) { return text.find("\033[") != std::string::npos; };
    CHECK(coloured(shown_on_terminal(line)));
    CHECK_FALSE(coloured(shown_on_terminal(line, 120, {{"NO_COLOR", "1"}})));
    CHECK(coloured(shown_on_terminal(line, 120, {{"NO_COLOR", ""}})));
    CHECK_FALSE(coloured(shown_on_terminal(line, 120, {{"TERM", "dumb"}})));
    CHECK(coloured(shown_on_terminal(line + " --color always", 120, {{"NO_COLOR", "1"}})));
    CHECK_FALSE(coloured(shown_on_terminal(line + " --color never")));
    CHECK_FALSE(coloured(detp(line).out));
    CHECK(coloured(detp(line + " --color always").out));
    for (const std::string format : {" --format json", " --format csv"})
      CHECK_FALSE(coloured(detp(line + " --color always" + format).out));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("blocks stand side by side if they fit, else below, each time with the first block") {
    CHECK(cli::side_by_side(blocks, {}) == "    a   A\n1   bb  BBBB\n22  c   C\n\n");
    CHECK(cli::side_by_side(blocks, {.width = 12}) == cli::side_by_side(blocks, {}));
    CHECK(cli::side_by_side(blocks, {.width = 11}) == "    a\n1   bb\n22  c\n\n    A\n1   BBBB\n22  C\n\n");
  }

  TEST_CASE("blocks are too wide if one of them does not fit beside the first") {
    CHECK_FALSE(cli::is_too_wide(blocks, {}));
    CHECK_FALSE(cli::is_too_wide(blocks, {.width = 8}));
    CHECK(cli::is_too_wide(blocks, {.width = 7}));
  }
}

}  // namespace detp::support
