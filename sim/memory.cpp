#include "memory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>

namespace detp::sim {

double memory_budget() {
  static const double budget =
      0.5 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return budget;
}

void require_memory(std::string_view what, double bytes) {
  if (bytes <= memory_budget()) return;
  throw std::length_error(fmt::format("{} would take {:.3g} GB, more than half of this machine's memory ({:.3g} GB)",
                                      what, bytes / 1e9, 2 * memory_budget() / 1e9));
}

}  // namespace detp::sim
