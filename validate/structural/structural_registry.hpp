#pragma once

#include <stop_token>
#include <string_view>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/technique/technique.hpp"

/// The function that computes the structural counts of each technique. Parameters have been checked and belong to the
/// technique.
namespace detp::validate {

/// Expected counts on `rays` isotropic lines through S₀, for the engine that choose runs, without hits. Throws
/// sim::Stopped if a stop was requested.
using StructuralCounts = Counts<double>(const sim::Problem& problem, double rays, const Parameters& parameters,
                                        const std::stop_token& stop);

struct StructuralModel {
  Technique technique;
  StructuralCounts* counts = nullptr;
  std::string_view why_none = {};  ///< reason, if there are no counts
};

[[nodiscard]] const StructuralModel& structural_model(Technique technique);

}  // namespace detp::validate
