#pragma once

#include "detp/sim/lists/list_walk.hpp"
#include "search.hpp"

namespace detp::sim::stream {

/// The float version of search_along (lists/plain/walk_search.hpp): finds the hits of all rays, with lists that follow
/// the discs in that order. Same bytes for any number of threads.
///
/// Each class of rays is a separate walk, block after block, so at most as many threads as classes are used. Counts are
/// those of one walk over all rays, except for rays that pass a sphere by less than the margin, and segments that end
/// before they reach a sphere (kernels-inl.hpp). `room` is the expected size of their lists.
void search_walk(const SearchInput& input, const MakeWalk& make_walk, const ListCapacity& room,
                 const RunOptions& options, Outcome& outcome);

}  // namespace detp::sim::stream
