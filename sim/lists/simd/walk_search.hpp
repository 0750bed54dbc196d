#pragma once

#include "detp/sim/lists/list_walk.hpp"
#include "search.hpp"

namespace detp::sim::stream {

/// The float version of search_along (technique/walk_search.hpp): finds the hits of all rays with lists that follow the
/// discs in that order. Same bytes for any number of threads.
///
/// Each class of rays is a walk of its own, block after block: as many threads as classes are of use. Counts are those
/// of one walk over all rays, but for rays that pass a sphere by less than the margin, and segments that end before
/// they reach one (kernels-inl.hpp). `room` is what their lists are expected to take.
void search_walk(const Searched& searched, const MakeWalk& make_walk, const ListRoom& room, const RunOptions& options,
                 Outcome& outcome);

}  // namespace detp::sim::stream
