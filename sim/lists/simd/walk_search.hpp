#pragma once

#include "detp/sim/lists/list_walk.hpp"
#include "search.hpp"

namespace detp::sim::stream {

/// The float version of search_along (lists/plain/walk_search.hpp): finds the hits of all rays, with lists that follow
/// the discs in the tree's order. The results have the same bytes for any number of threads.
///
/// Each class of rays has its own walk in each block, so at most as many threads as classes search. Visits and culls
/// are counted once per block. Tests and listed rays are those of one walk over all rays, plus rays that miss a sphere
/// by less than the margin and some segments that end before the sphere (kernels-inl.hpp). `room` is the expected size
/// of the lists.
void search_walk(const SearchInput& input, const MakeWalk& make_walk, const ListCapacity& room,
                 const RunOptions& options, Outcome& outcome);

}  // namespace detp::sim::stream
