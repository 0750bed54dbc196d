#include "detp/validate/cli/text/progress_line.hpp"
#include "support/attempts.hpp"
#include "support/terminal.hpp"

#include <doctest/doctest.h>

namespace detp::support {
namespace {

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
  TEST_CASE("no progress is shown in pipes, nor if quiet, nor of work that is done at once") {
    CHECK(detp("run @cornell --rays 100").err.empty());
    CHECK(drawings_in(shown_on_terminal("run @cornell --rays 100 --quiet")).empty());
    CHECK(drawings_in(shown_on_terminal("model --samples 10 --disc-radius 0.1 --scene-side 2")).empty());
  }
}

TEST_SUITE("statistical") {  // because it takes long
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
