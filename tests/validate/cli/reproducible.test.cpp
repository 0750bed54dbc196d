#include <doctest/doctest.h>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "support/run_support.hpp"

namespace detp::support {

TEST_SUITE("long") {
  TEST_CASE("the number of threads changes only the time") {
    for (const Technique technique : all_techniques) {
      CAPTURE(name(technique));
      const std::string options = "--technique " + std::string(name(technique)) + " --threads ";
      const Written one = run_and_read(words("run @cornell --rays 3000"), options + "1");
      const Written two = run_and_read(words("run @cornell --rays 3000"), options + "2");
      CHECK(one == two);
      const auto without_predicted_times = [](Json json) {
        for (const char* name : {"predicted_seconds", "predicted_seconds_again"}) json.erase(name);
        return without_times(json);
      };
      CHECK(without_predicted_times(one.json) == without_predicted_times(two.json));
      CHECK(one.json.at("provenance").at("threads") == 1);
      CHECK(two.json.at("provenance").at("threads") == 2);
    }
    for (const std::string line : {"choose @cornell --rays 1000 --costs t=1e-9,u=1e-9,s=5e-8",  // prices one thread
                                   "scene @cornell --rays 5000", "scene @uniform --samples 5000 --rays 5000",
                                   "model @cornell --rays 5000", "validate --samples 100 --rays 320"}) {
      CAPTURE(line);
      const Finished one = detp(line + " --format json --threads 1");
      const Finished two = detp(line + " --format json --threads 2");
      CHECK(one.code == two.code);
      CHECK(without_times(one.json()) == without_times(two.json()));
    }
  }
}

TEST_SUITE("end to end") {
  TEST_CASE("the same seed gives the same bytes, and another seed gives other hits") {
    for (const std::string problem : {"run @cornell --rays 3000", "run @uniform --samples 2000 --rays 2000",
                                      "run --samples 2000 --rays 2000 --disc-radius 0.1 --scene-side 2"}) {
      CAPTURE(problem);
      const Written first = run_and_read(words(problem), "--seed 3");
      CHECK(run_and_read(words(problem), "--seed 3") == first);
      CHECK_FALSE(run_and_read(words(problem), "--seed 4") == first);
      CHECK(run_and_read(words(problem), "") == run_and_read(words(problem), "--seed 1"));
    }
  }
}

}  // namespace detp::support
