#include "predict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "registry.hpp"

namespace detp::model {

namespace {

/// Lists made and discs visited in blocks of rays, the last one smaller.
void count_by_blocks(const Valid<Workload>& workload, const Valid<Candidate>& candidate, Counts<double>& counts) {
  constexpr double many = 1e9;  // as far as the number of samples matters to rays_in_block
  const auto block = static_cast<double>(rays_in_block(static_cast<std::size_t>(std::min(workload.samples, many))));
  const double whole = std::floor(workload.rays / block);
  const double rest = workload.rays - whole * block;
  const auto predict_block = [&](double rays) {
    Workload fewer = workload;
    fewer.rays = rays;
    return model_of(candidate.technique).predict(Valid<Workload>(workload, fewer), candidate);
  };
  if (whole < 1) return;
  const Counts<double> full = predict_block(block);
  counts.culls = whole * full.culls;
  counts.visits = whole * full.visits;
  if (rest < 1) return;
  const Counts<double> last = predict_block(rest);
  counts.culls += last.culls;
  counts.visits += last.visits;
}

}  // namespace

Counts<double> predict(const Valid<Workload>& workload, const Valid<Candidate>& candidate, Engine engine) {
  if (!has_closed_form(candidate.technique))
    throw std::invalid_argument(
        fmt::format("there is no closed form of {}; it can only be run", name(candidate.technique)));
  Counts<double> counts = model_of(candidate.technique).predict(workload, candidate);
  if (engine == Engine::simd && record_of(candidate.technique).simd) count_by_blocks(workload, candidate, counts);
  return counts;
}

}  // namespace detp::model
