#include <doctest/doctest.h>

#include "support/command.hpp"
#include "support/sanitized.hpp"

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
         {"run @uniform --rays 1000 --samples 100000 --technique bvh --memory-limit 11M", "GB"},
         {"run @uniform --rays 1000 --samples 100000 --technique sphere-tree --memory-limit 11M", "GB"},
         {"run @uniform --rays 1000 --samples 100000 --technique brute-force --memory-limit 11M", "GB"},
         {"run @uniform --rays 1000 --samples 100 --memory-limit lots", "--memory-limit must be a size"},
         {"run @uniform --rays 1000 --samples 100 --memory-limit 0", "--memory-limit must be a size"}});
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
      CAPTURE(addresses);
      CAPTURE(finished.err);
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

  TEST_CASE("an allocation that fails nevertheless is reported as out of memory, by Embree too") {
    if (sanitized) return;
    // The allocation fails in the technique, while the scene is read or sorted, and in Embree.
    const double addresses = addresses_of_little_work() + 96e6;
    for (const char* work : {"grid --cells 400 --samples 1e5", "sphere-tree --samples 3e6",
                             "sphere-cache --ratio 0.6 --samples 1e6", "bvh --samples 2e5"})
      check_short_of(
          detp::support::detp_in(
              addresses, "run @uniform --rays 10 --threads 1 --memory-limit 100G --disc-radius 0.1% --technique " +
                             std::string(work)),
          "out of memory");
  }
}
