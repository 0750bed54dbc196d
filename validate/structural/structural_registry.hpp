#pragma once

#include <stop_token>
#include <string_view>

#include "detp/model/vocabulary/ray_blocks.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/technique/technique.hpp"

/// For each technique, the function that computes its structural counts, or the reason why there is none. Callers pass
/// checked parameters of the same technique.
namespace detp::validate {

/// Isotropic lines through S₀, and the engine that searches them.
struct Lines {
  double rays = 0;
  Engine engine = Engine::simd;

  [[nodiscard]] RayBlocks blocks(const sim::Problem& problem) const {
    return ray_blocks(rays, static_cast<double>(problem.discs().size()), engine);
  }
};

/// Returns the expected counts of a search, without hits. Throws sim::Stopped if a stop was requested.
using StructuralCounts = Counts<double>(const sim::Problem& problem, const Lines& lines, const Parameters& parameters,
                                        const std::stop_token& stop);

struct StructuralModel {
  Technique technique;
  StructuralCounts* counts = nullptr;
  std::string_view why_none = {};  ///< reason why `counts` is null
};

[[nodiscard]] StructuralModel structural_model(Technique technique);

}  // namespace detp::validate
