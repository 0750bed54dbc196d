#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "timed_run.hpp"

/// The files of what a run found. They appear complete or not at all. Throw sim::FileError, and sim::Stopped on a stop request.
namespace detp::cli {

/// "ray,disc" for each pair. `order`: numbers of the rays in their file; empty if they have the file's order.
void write_pairs(const std::string& path, const TimedRun& run, const std::vector<std::uint32_t>& order,
                 const std::stop_token& stop);

/// Hits and irradiance of each disc; with standard errors and bounds if they were asked for.
void write_per_disc(const std::string& path, const TimedRun& run, const std::vector<std::uint32_t>& vertices,
                    const std::stop_token& stop);

}  // namespace detp::cli
