#include "detp/validate/choice/plan.hpp"

#include <nlohmann/json.hpp>

#include "detp/validate/choice/candidate_json.hpp"
#include "guard.hpp"
#include "types.hpp"

using namespace detp;

namespace {

/// By area, with sum 1.
std::vector<double> weights_of(const sim::DiscsView& discs) {
  std::vector<double> weights(discs.count);
  double sum = 0;
  for (std::size_t i = 0; i < discs.count; ++i) sum += weights[i] = discs.radii[i] * discs.radii[i];
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::optional<double> unless_zero(double value) { return value == 0 ? std::nullopt : std::optional(value); }

detp_plan* handle_of(validate::Plan plan, std::vector<double> weights) {
  const Candidate candidate = plan.candidate();
  const std::size_t discs = weights.size();
  return new detp_plan{std::move(plan), discs, std::move(weights), std::string(name(candidate.technique)),
                       to_json(candidate).dump()};
}

}  // namespace

extern "C" {

detp_status detp_plan_create(const detp_discs* discs, const detp_rays* rays, const detp_plan_options* options,
                             detp_plan** plan, detp_error* error) {
  return c::guarded(error, [&] {
    detp_plan*& made = c::given(plan, "plan");
    const detp_plan_options own = options != nullptr ? c::known(options, "options") : detp_plan_options{};
    const sim::DiscsView discs_view = c::view_of(discs);
    const sim::RaysView rays_view = c::view_of(rays);
    c::Watch watch(own.progress, own.user, "planning");
    validate::PlanOptions wanted{.rays = unless_zero(own.rays),
                                 .farthest = unless_zero(own.farthest),
                                 .front_facing = own.front_facing != 0,
                                 .threads = own.threads,
                                 .once = own.once != 0,
                                 .stop = watch.token(),
                                 .progress = watch.report()};
    if (own.costs != nullptr) wanted.costs = own.costs->table;
    validate::Plan planned = validate::plan(discs_view, rays_view, wanted);
    made = handle_of(std::move(planned), weights_of(discs_view));
  });
}

detp_status detp_plan_with_radius(const detp_plan* plan, double radius, double rays, detp_plan** changed,
                                  detp_error* error) {
  return c::guarded(error, [&] {
    detp_plan*& made = c::given(changed, "changed");
    const detp_plan& old = c::given(plan, "plan");
    made = handle_of(validate::replan(old.plan, radius, unless_zero(rays)),
                     std::vector(old.discs, 1 / static_cast<double>(old.discs)));
  });
}

void detp_plan_free(detp_plan** plan) {
  if (plan == nullptr) return;
  delete *plan;
  *plan = nullptr;
}

detp_status detp_plan_describe(const detp_plan* plan, detp_plan_facts* facts, detp_error* error) {
  return c::guarded(error, [&] {
    const detp_plan& one = c::given(plan, "plan");
    detp_plan_facts ours = c::known(facts, "facts");
    ours.technique = one.technique.c_str();
    ours.parameters = one.parameters.c_str();
    ours.discs = one.discs;
    ours.threads = one.plan.threads();
    ours.predicted_seconds = one.plan.predicted_seconds();
    ours.predicted_seconds_again = one.plan.predicted_seconds_again();
    ours.prepare_seconds = one.plan.prepare_seconds();
    ours.peak_bytes = one.plan.peak_bytes();
    ours.predicted_error = one.plan.predicted_error();
    ours.planning_seconds = one.plan.planning_seconds();
    c::write_back(facts, ours);
  });
}
}
