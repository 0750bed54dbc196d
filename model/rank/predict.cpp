#include "predict.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "detp/model/techniques/registry.hpp"

namespace detp::model {

Counts<double> predict(const Valid<Workload>& workload, const Valid<Candidate>& candidate, Engine engine) {
  if (!has_closed_form(candidate.technique))
    throw std::invalid_argument(
        fmt::format("there is no closed form of {}; it can only be run", name(candidate.technique)));
  Counts<double> counts = model_of(candidate.technique).predict(workload, candidate, engine);
  counts.loaded = workload.rays;
  if (some_rays_end(workload)) counts.segments = workload.rays;
  return with_bytes_touched(counts, candidate, engine);
}

std::vector<std::string> extrapolations(const Valid<Workload>& workload, const Valid<Candidate>& candidate) {
  Reasons reasons;
  if (const auto uncounted = model_of(candidate.technique).uncounted)
    uncounted(workload, candidate.parameters, reasons);
  return std::move(reasons).texts();
}

}  // namespace detp::model
