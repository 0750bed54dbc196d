#include "run_memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "detp/sim/base/memory.hpp"

namespace detp::sim {
namespace {

/// For partly used pages, small arrays and threads' stacks.
constexpr double small_bytes = 0x1p19;

double given_bytes(const Problem& problem) {
  return static_cast<double>(problem.rays().size()) * sizeof(Ray) +
         static_cast<double>(problem.discs().size()) * sizeof(Disc);
}

}  // namespace

bool fits_memory(double bytes, const Problem& problem) { return given_bytes(problem) + bytes <= memory_budget(); }

void require_memory_for(std::string_view what, double bytes, const Problem& problem) {
  if (fits_memory(bytes, problem)) return;
  require_memory(fmt::format("{} rays, {} discs, and {}", problem.rays().size(), problem.discs().size(), what),
                 given_bytes(problem) + bytes);
}

double checked_bytes(std::string_view what, double bytes, const Problem& problem) {
  bytes += small_bytes;
  require_memory_for(what, bytes, problem);
  return bytes;
}

void add_checked_bytes(std::string_view what, double bytes, const Problem& problem, Outcome& outcome) {
  outcome.bytes = std::max(outcome.bytes, checked_bytes(what, bytes, problem));
}

double found_bytes(const Problem& problem, const RunOptions& options) {
  constexpr double a_disc = sizeof(DiscTotals) + sizeof(std::uint64_t) + sizeof(double);
  return options.totals != nullptr ? 0 : a_disc * static_cast<double>(problem.discs().size());
}

}  // namespace detp::sim
