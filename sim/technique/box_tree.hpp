#pragma once

#include "detp/sim/lists/simd/disc_tree.hpp"
#include "detp/sim/search/index.hpp"

namespace detp::sim {

/// The index of a box tree over discs that are sorted already. Throws as `prepare`.
[[nodiscard]] std::unique_ptr<Index> prepare_box_tree(const Problem& problem, stream::SortedDiscs discs,
                                                      const BoxTreeParameters& parameters, const RunOptions& options);

}  // namespace detp::sim
