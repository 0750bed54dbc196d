#pragma once

#include "index.hpp"

/// What prepares the search of each technique. Parameters have been checked and are the technique's own.
namespace detp::sim {

using Prepare = std::unique_ptr<Index>(const Problem& problem, const Parameters& parameters, const RunOptions& options);

struct TechniqueSearch {
  Technique technique;
  Prepare* prepare;
};

[[nodiscard]] const TechniqueSearch& search_of(Technique technique);

}  // namespace detp::sim
