#include "predict.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "registry.hpp"

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

}  // namespace detp::model
