#include "detp/sim/base/stopwatch.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

using namespace detp::sim;

TEST_SUITE("known answer") {
  TEST_CASE("a stopwatch counts time asleep, and restarts after a lap") {
    const Stopwatch whole;
    Stopwatch watch;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const double read = watch.seconds();
    const double lap = watch.lap();
    CHECK(read >= 0.005);
    CHECK(lap >= read);
    const double after = watch.seconds();
    CHECK(lap + after <= whole.seconds());
  }
}
