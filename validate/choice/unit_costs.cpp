#include "unit_costs.hpp"

#include <stdexcept>
#include <vector>

#include "detp/validate/statistics/non_negative_fit.hpp"

namespace detp::validate {
namespace {

/// Seconds per unit of a term that is the only term of its phase: Σ seconds / Σ counts. The sums are over the runs of
/// techniques that search ray by ray if `ray_by_ray` is true, else over the runs of all other techniques.
double simple_rate(std::span<const TimedRun> runs, bool ray_by_ray, double TimedRun::*seconds,
                   double Counts<double>::*term) {
  double time = 0;
  double count = 0;
  for (const TimedRun& run : runs) {
    if (record_of(run.technique).ray_by_ray != ray_by_ray) continue;
    time += run.counts.*term > 0 ? run.*seconds : 0;
    count += run.counts.*term;
  }
  return count > 0 ? time / count : 0;
}

}  // namespace

UnitCosts built_in_unit_costs() {
  return {.cull_test = 5.3e-10,
          .disc_test = 1.6e-10,
          .index_test = 5.8e-9,
          .step = 1.5e-8,
          .node = 4.9e-8,
          .listed = 0,  // included in cull_test: the fit cannot separate both
          .placement = 1.1e-7,
          .leaf = 1.1e-8,
          .sort = 1.1e-8,
          .cull = 9.0e-8};
}

UnitCosts fit_unit_costs(std::span<const TimedRun> runs) {
  constexpr std::size_t terms = 7;
  if (runs.size() < terms) throw std::invalid_argument("a fit of unit costs takes at least as many runs as costs");
  std::vector<double> shares;  // count divided by the run's time, for each cost
  for (const TimedRun& run : runs) {
    const Counts<double>& counts = run.counts;
    const bool index = record_of(run.technique).ray_by_ray;
    for (const double count : {counts.cull_tests, index ? 0 : counts.disc_tests, index ? counts.disc_tests : 0,
                               counts.steps, counts.nodes, counts.listed, counts.culls})
      shares.push_back(count / run.search);
  }
  const std::vector<double> x = non_negative_fit(shares, terms, std::vector<double>(runs.size(), 1.0));
  return {.cull_test = x[0],
          .disc_test = x[1],
          .index_test = x[2],
          .step = x[3],
          .node = x[4],
          .listed = x[5],
          .placement = simple_rate(runs, true, &TimedRun::build, &Counts<double>::placements),
          .leaf = simple_rate(runs, false, &TimedRun::build, &Counts<double>::placements),
          .sort = simple_rate(runs, false, &TimedRun::order, &Counts<double>::sorted),
          .cull = x[6]};
}

}  // namespace detp::validate
