#include <doctest/doctest.h>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "support/command.hpp"
#include "support/machine.hpp"
#include "support/run_support.hpp"

using detp::support::check_refused;
using detp::support::Finished;
using detp::support::Json;
using detp::support::result_of;
using detp::support::sanitized;

namespace {

void check_short_of(const Finished& finished, const std::string& named) {
  CAPTURE(finished.err);
  CHECK(finished.signal == 0);
  CHECK(finished.code == 2);
  CHECK(finished.out.empty());
  CHECK(finished.err.find('\n') + 1 == finished.err.size());
  CHECK(finished.err.find(named) != std::string::npos);
}

/// The address space that the command needs for hardly any work, mostly for its libraries; to within 4 MB.
double addresses_of_little_work() {
  double bytes = 40e6;
  while (bytes < 4e9 && detp::support::detp_in(bytes, "run @uniform --rays 10 --samples 10 --threads 1").code != 0)
    bytes += 4e6;
  return bytes;
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("work that would exceed --memory-limit is refused before allocation, naming the bytes") {
    check_refused(
        {{"run @uniform --rays 1000 --samples 1000 --technique sphere-cache --ratio 0.999999999 "
          "--spheres 1000000000000 --memory-limit 2G",
          "the spheres would take"},
         {"run @uniform --rays 1000 --samples 100000 --technique grid --memory-limit 11M", "more than the memory"},
         {"run @uniform --rays 1000 --samples 100000 --technique octree --depth 5 --memory-limit 11M", "GB"},
         {"run @uniform --rays 1000 --samples 100000 --technique bsp --memory-limit 11M", "GB"},
         {"run @uniform --rays 1000 --samples 100000 --technique sphere-tree --memory-limit 11M", "GB"},
         {"run @uniform --rays 1000 --samples 100000 --technique brute-force --memory-limit 11M", "GB"},
         {"run @uniform --rays 1000 --samples 100 --memory-limit lots", "--memory-limit must be a size"},
         {"run @uniform --rays 1000 --samples 100 --memory-limit 0", "--memory-limit must be a size"}});
    if (detp::has_embree)
      check_refused({{"run @uniform --rays 1000 --samples 100000 --technique bvh --memory-limit 11M", "GB"}});
  }

  TEST_CASE("ten rays on 4096 threads need little memory") {
    const Json result = result_of(
        "run @uniform --rays 10 --samples 100 --technique sphere-tree --threads 4096 --memory-limit 1G --quiet");
    CHECK(result.at("hits").get<int>() >= 0);
  }

  TEST_CASE("choosing by closed forms does not hold the rays in memory, however many there are") {
    const Json few = result_of("choose @uniform --samples 1000 --disc-radius 1% --rays 1e6 --memory-limit 500M");
    const Json many = result_of("choose @uniform --samples 1000 --disc-radius 1% --rays 1e12 --memory-limit 500M");
    CHECK(many.at("inputs").at("rays") == 1e12);
    CHECK(few.at("inputs").at("path_length") == many.at("inputs").at("path_length"));
  }

  TEST_CASE("if the system does not start all threads, fewer are used") {
    if (sanitized) return;  // a sanitizer needs address space
    const Finished finished = detp::support::detp_in(
        6e9, "run @uniform --rays 1000 --samples 100 --technique grid --threads 4096 --memory-limit 1G");
    CAPTURE(finished.err);
    CHECK(finished.code == 0);
    CHECK(finished.err.find("of 4096 threads only") != std::string::npos);
  }

  TEST_CASE("without memory for any thread, one line says so") {
    if (sanitized) return;
    int refused = 0;
    for (double addresses = 30e6; addresses < 400e6; addresses += 3e6) {  // a thread takes 8 MB
      const Finished finished =
          detp::support::detp_in(addresses, "model --samples 10 --disc-radius 0.1 --scene-side 1");
      INFO("addresses ", addresses, ", finished.err ", finished.err);
      if (finished.code == 0) break;
      if (finished.code == 127) continue;  // the libraries are not loaded
      // Embree's own start, before main(), has no memory: it fails without a word, or has none to throw an exception.
      if (refused == 0 && (finished.err.starts_with("terminate called without an active exception") ||
                           (finished.signal == SIGSEGV && finished.err.empty())))
        continue;
      REQUIRE(finished.signal == 0);
      if (finished.code == 2 && finished.err.find("out of memory") != std::string::npos) continue;
      CHECK(finished.code == 4);
      CHECK(finished.err.starts_with("detp: the system starts no thread; "));
      CHECK(finished.err.find('\n') + 1 == finished.err.size());
      ++refused;
    }
    CHECK(refused > 0);
  }

  TEST_CASE("an allocation that fails nevertheless is reported as out of memory, by Embree too" *
            doctest::test_suite("long")) {
    if (sanitized) return;
    // The allocation fails in the technique, while the scene is read or sorted, and in Embree.
    const double addresses = addresses_of_little_work() + 96e6;
    for (const char* work :
         {"grid --cells 400 --samples 1e5", "sphere-tree --samples 3e6", "sphere-cache --ratio 0.6 --samples 1e6",
          detp::has_embree ? "bvh --samples 2e5" : "bsp --samples 2e6"})
      check_short_of(
          detp::support::detp_in(
              addresses, "run @uniform --rays 10 --threads 1 --memory-limit 100G --disc-radius 0.1% --technique " +
                             std::string(work)),
          "out of memory");
  }
}

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
