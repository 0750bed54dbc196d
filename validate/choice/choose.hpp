#pragma once

#include "detp/sim/search/views.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "measure.hpp"

namespace detp::validate {

/// The technique, with parameters, that is predicted to find the hits of these rays and discs fastest: the first of
/// model::rank for the measured workload. Does not search for hits. Throws as make_problem does.
[[nodiscard]] Candidate choose(std::span<const sim::Ray> rays, std::span<const sim::Disc> discs,
                               const CostTable& costs = built_in_unit_costs());
[[nodiscard]] Candidate choose(const sim::RaysView& rays, const sim::DiscsView& discs,
                               const CostTable& costs = built_in_unit_costs());

}  // namespace detp::validate
