#pragma once

#include "detp/sim/search/views.hpp"
#include "measure.hpp"
#include "unit_costs.hpp"

namespace detp::validate {

/// The technique that is predicted to find the hits of such rays and discs fastest, with its parameters: measure, then
/// model::rank. Nothing is searched. Throws as make_problem does.
[[nodiscard]] Candidate choose(std::span<const sim::Ray> rays, std::span<const sim::Disc> discs,
                               const UnitCosts& costs = built_in_unit_costs());
[[nodiscard]] Candidate choose(const sim::RaysView& rays, const sim::DiscsView& discs,
                               const UnitCosts& costs = built_in_unit_costs());

}  // namespace detp::validate
