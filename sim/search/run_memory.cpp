#include "run_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "detp/sim/base/memory.hpp"
#include "irradiance.hpp"

namespace detp::sim {
namespace {

/// For partly used pages, small arrays and threads' stacks.
constexpr double small_bytes = 0x1p19;

double given_bytes(const Problem& problem) {
  return problem.kept_bytes() + static_cast<double>(problem.rays().size() * bytes_of_ray_in(problem.bands())) +
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

double sums_bytes(const Problem& problem, const RunOptions& options) {
  const bool own = options.totals == nullptr;
  const auto discs = static_cast<double>(problem.discs().size());
  const bool errors = own ? options.standard_error : options.totals->keeps_errors();
  const std::uint64_t last = last_block(problem, options);
  const double levels = static_cast<double>(std::bit_width(last)) * sizeof(double) * (errors ? 2.0 : 1.0) * discs;
  const double of_errors = (errors ? (own ? error_bytes : sizeof(PhotonSums)) * discs : 0);
  const auto bands = static_cast<double>(problem.bands());
  const double further = (bands - 1) * (sizeof(DiscTotals) + (own ? sizeof(double) : 0)) * discs;
  return bands * (levels + of_errors) + further;
}

double found_bytes(const Problem& problem, const RunOptions& options) {
  constexpr double a_disc = sizeof(DiscTotals) + sizeof(std::uint64_t) + sizeof(double);
  const double found = options.totals != nullptr ? 0 : a_disc * static_cast<double>(problem.discs().size());
  return found + sums_bytes(problem, options);
}

std::uint64_t first_photon(const RunOptions& options) { return options.totals == nullptr ? 0 : options.totals->rays(); }

PhotonBlocks photon_blocks(const Problem& problem, const RunOptions& options) {
  const bool given = options.totals != nullptr && !options.totals->empty();
  return given ? options.totals->photon_blocks() : PhotonBlocks::for_discs(problem.discs().size());
}

std::uint64_t last_block(const Problem& problem, const RunOptions& options) {
  return photon_blocks(problem, options).of(problem.photon(problem.rays().size() - 1, first_photon(options)));
}

}  // namespace detp::sim
