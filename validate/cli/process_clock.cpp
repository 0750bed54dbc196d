#include "process_clock.hpp"

#include "detp/sim/base/stopwatch.hpp"

namespace detp::cli {
namespace {

const sim::Stopwatch since_start;

}  // namespace

double seconds_since_start() { return since_start.seconds(); }

}  // namespace detp::cli
