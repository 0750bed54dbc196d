#pragma once

#include <functional>

#include "detp/model/rank/registry.hpp"
#include "detp/sim/ranks/ranks.hpp"

namespace detp::cli {

/// A candidate, and the number of threads of its run.
struct Requested {
  Candidate candidate = {};
  int threads = 1;
};

/// What rank 0 requests, on all ranks; `ranks` null: on this process alone.
[[nodiscard]] Requested agreed(sim::Ranks* ranks, const std::function<Requested()>& of_first);

}  // namespace detp::cli
