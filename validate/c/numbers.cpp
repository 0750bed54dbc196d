#include <cstring>
#include <nlohmann/json.hpp>

#include "detp/validate/choice/candidate_json.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/job/job.hpp"
#include "guard.hpp"
#include "handles.hpp"

using namespace detp;

extern "C" detp_status detp_choose(const detp_workload* workload, const detp_costs* costs, int threads, char* text,
                                   size_t room, detp_plan_facts* facts, detp_error* error) {
  return c::guarded(error, [&] {
    const detp_workload given = c::known(workload, "workload");
    detp_plan_facts ours = c::known(facts, "facts");
    c::given(text, "text");
    validate::JobRequest request;
    request.rays = given.rays;
    request.samples = given.samples;
    request.disc_radius = validate::Length{given.disc_radius};
    request.scene_side = given.scene_side;
    request.dimension = given.dimension == 0 ? 3 : given.dimension;
    const CostTable table = costs != nullptr ? costs->table : validate::built_in_unit_costs();
    const validate::Choice choice = validate::choose(
        {.workload = validate::workload_of_numbers(request), .rigor = Rigor::estimate, .threads = threads}, table);
    const Prediction& best = choice.best();
    const std::string technique(name(best.candidate.technique));
    const std::string parameters = to_json(best.candidate).dump();
    if (technique.size() + parameters.size() + 2 > room)
      throw std::invalid_argument("text has no room for " + std::to_string(technique.size() + parameters.size() + 2) +
                                  " bytes");
    std::memcpy(text, technique.c_str(), technique.size() + 1);
    std::memcpy(text + technique.size() + 1, parameters.c_str(), parameters.size() + 1);
    ours.technique = text;
    ours.parameters = text + technique.size() + 1;
    ours.discs = 0;
    ours.threads = best.threads;
    ours.predicted_seconds = best.time.total();
    ours.predicted_error = 0;
    ours.planning_seconds = choice.choosing_seconds;
    c::write_back(facts, ours);
  });
}
