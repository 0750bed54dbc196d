#pragma once

#include <stop_token>
#include <vector>

#include "detp/sim/geometry/disc_source.hpp"
#include "problem.hpp"

namespace detp::sim {

/// What a problem knows of its discs.
struct DiscSummary {
  Sphere enclosing;  ///< S₀ (enclosing_sphere)
  Box centres;
  DiscRadii radii;
};

/// Reads all discs once. Throws as make_problem, with the disc's number, and as DiscSource::read.
[[nodiscard]] DiscSummary summary_of(const DiscSource& discs, const std::stop_token& stop = {});

/// Every k-th disc, at most so many. Throws as DiscSource::read.
[[nodiscard]] std::vector<Disc> sample_of(const DiscSource& discs, std::uint64_t most,
                                          const std::stop_token& stop = {});

}  // namespace detp::sim
