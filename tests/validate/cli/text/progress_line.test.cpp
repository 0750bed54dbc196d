#include "detp/validate/cli/text/progress_line.hpp"
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
         {"validate --rays 100000 --samples 5000", "run @tree --rays 3000000 --technique sphere-cache --threads 1",
          "choose @tree --rays 1000000 --disc-radius 1% --analyze"}) {
      CAPTURE(line);
      const auto drawings = drawings_in(shown_on_terminal(line));
      REQUIRE(drawings.size() > 5);
      std::set<int> shares;
      int last = 0;
      bool left = false;
      for (const Drawing& drawing : drawings) {
        CHECK(drawing.share >= last);
        CHECK(drawing.share <= 100);
        last = drawing.share;
        shares.insert(drawing.share);
        left = left || drawing.text.ends_with(" left");
      }
      CHECK(left);
      CHECK(shares.size() > drawings.size() / 20);
      CHECK(last > 50);
    }
  }
}

}  // namespace detp::support
