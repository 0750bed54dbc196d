#pragma once

#include "detp.h"
#include "detp/model/vocabulary/counts.hpp"

namespace detp::c {

[[nodiscard]] inline detp_counts counts_of(const Counts<double>& counts) {
  return {.loaded = counts.loaded,
          .segments = counts.segments,
          .cull_tests = counts.cull_tests,
          .culls = counts.culls,
          .listed = counts.listed,
          .visits = counts.visits,
          .disc_tests = counts.disc_tests,
          .doubtful = counts.doubtful,
          .steps = counts.steps,
          .nodes = counts.nodes,
          .references = counts.references,
          .placements = counts.placements,
          .made = counts.made,
          .sorted = counts.sorted,
          .hits = counts.hits,
          .bytes_touched = counts.bytes_touched};
}

}  // namespace detp::c
