#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include "support/attempts.hpp"
#include "support/command.hpp"
#include "support/sanitized.hpp"

namespace detp::support {
namespace {

/// Pages that a command touched for the first time.
double pages_of(const std::string& line) {
  rusage before{};
  getrusage(RUSAGE_CHILDREN, &before);
  REQUIRE(detp(line).code == 0);
  rusage after{};
  getrusage(RUSAGE_CHILDREN, &after);
  return static_cast<double>(after.ru_minflt - before.ru_minflt);
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("a repeated search touches no memory for the first time, and has the arrays of the search before") {
    if (sanitized) return;  // a sanitizer keeps freed memory apart
    for (const char* how : {"--technique box-tree --fan-out 4 --leaf 16", "--technique sphere-cache --ratio 0.6",
                            "--technique octree --depth 6", "--technique grid --cells 40"}) {
      CAPTURE(how);
      const std::string line = fmt::format("run @cornell --rays 60000 {} --quiet --repeat ", how);
      double few = 0;
      CHECK(in_attempts(3, [&] {  // the system may split a large page meanwhile
        few = pages_of(line + "3");
        return (pages_of(line + "23") - few) / 20 <= 20;
      }));
      CHECK(pages_of(line + "3 --memory-limit 1G") > few);  // with a limit, memory goes back at once
    }
  }
}

}  // namespace detp::support
