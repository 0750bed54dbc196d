#include <doctest/doctest.h>
#include <pty.h>

#include <cstdlib>

#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "support/attempts.hpp"
#include "support/command.hpp"

namespace detp::support {

// Runs the command on a terminal of its own.

using Environment = std::vector<std::pair<std::string, std::string>>;

/// The command's stdout and stderr as a terminal with `columns` columns receives them, with \r\n converted to \n.
inline std::string shown_on_terminal(const std::string& line, unsigned short columns = 120,
                                     const Environment& environment = {}) {
  std::vector<std::string> all{DETP_COMMAND};
  for (const std::string& word : words(line)) all.push_back(word);
  std::vector<char*> pointers;
  for (std::string& word : all) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const winsize size{.ws_row = 40, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
  int terminal = -1;
  const pid_t id = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (id == 0) {
    ::unsetenv("NO_COLOR");
    ::setenv("TERM", "xterm", 1);
    for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }
  if (id < 0) throw std::runtime_error("cannot open a terminal");
  std::string shown;
  char buffer[4096];
  for (ssize_t count = 0; (count = ::read(terminal, buffer, sizeof buffer)) > 0;)
    shown.append(buffer, static_cast<std::size_t>(count));
  ::close(terminal);
  int status = 0;
  ::waitpid(id, &status, 0);
  return std::regex_replace(shown, std::regex("\r\n"), "\n");
}

}  // namespace detp::support

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

struct Drawing {
  int share = 0;
  std::string text;
};

std::vector<Drawing> drawings_in(const std::string& shown) {
  std::vector<Drawing> drawings;
  const std::regex line("\r\033\\[K *([0-9]+) %  ([^\r\n]*)");
  for (std::sregex_iterator one(shown.begin(), shown.end(), line), end; one != end; ++one)
    drawings.push_back({std::stoi((*one)[1]), (*one)[2]});
  return drawings;
}

struct Progress {
  std::size_t drawings = 0;
  std::size_t shares = 0;  ///< that differ
  int last = 0;            ///< %
  bool left = false;       ///< the time left was told
};

Progress progress_of(const std::string& line) {
  CAPTURE(line);
  Progress seen;
  std::set<int> shares;
  for (const Drawing& drawing : drawings_in(shown_on_terminal(line))) {
    ++seen.drawings;
    CHECK(drawing.share >= seen.last);
    CHECK(drawing.share <= 100);
    seen.last = drawing.share;
    shares.insert(drawing.share);
    seen.left = seen.left || drawing.text.ends_with(" left");
  }
  seen.shares = shares.size();
  return seen;
}

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

  TEST_CASE("durations are given in seconds, minutes or hours, rounded up") {
    CHECK(cli::duration_text(0) == "1 s");
    CHECK(cli::duration_text(11.2) == "12 s");
    CHECK(cli::duration_text(99) == "99 s");
    CHECK(cli::duration_text(100) == "2 min");
    CHECK(cli::duration_text(3600) == "60 min");
    CHECK(cli::duration_text(7201) == "2 h 1 min");
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

  TEST_CASE("no progress is shown in pipes, nor if quiet, nor of work that is done at once") {
    CHECK(detp("run @cornell --rays 100").err.empty());
    CHECK(drawings_in(shown_on_terminal("run @cornell --rays 100 --quiet")).empty());
    CHECK(drawings_in(shown_on_terminal("model --samples 10 --disc-radius 0.1 --scene-side 2")).empty());
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

TEST_SUITE("statistical") {
  TEST_CASE("progress on a terminal never goes back, seldom stands still and tells the time left") {
    for (const std::string line :
         {"validate --samples 5000 --threads 1 --rays ", "run @tree --technique sphere-cache --threads 1 --rays ",
          "choose @tree --disc-radius 1% --analyze --threads 1 --rays "}) {
      // A fast machine needs more work to show, and a busy one may hide how far the work is.
      double rays = line.starts_with("validate") ? 1e5 : line.starts_with("run") ? 3e6 : 1e6;
      CHECK_MESSAGE(in_attempts(4,
                                [&] {
                                  const Progress seen = progress_of(line + std::to_string(static_cast<long>(rays)));
                                  if (seen.drawings <= 5) rays *= 4;
                                  return seen.drawings > 5 && seen.left &&
                                         seen.shares > std::min<std::size_t>(seen.drawings / 20, 30) && seen.last > 50;
                                }),
                    line);
    }
  }
}

}  // namespace detp::support
