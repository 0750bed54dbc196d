#include "unit_costs.hpp"

#include <Eigen/Dense>
#include <stdexcept>
#include <vector>

namespace detp::validate {
namespace {

/// x >= 0 that minimises |A x - 1|.
Eigen::VectorXd non_negative_fit(const Eigen::MatrixXd& a) {
  std::vector<Eigen::Index> kept(static_cast<std::size_t>(a.cols()));
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = static_cast<Eigen::Index>(i);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.cols());
  while (!kept.empty()) {
    const Eigen::MatrixXd part = a(Eigen::all, kept);
    const Eigen::VectorXd scale = part.colwise().norm().cwiseMax(1e-300);
    const Eigen::VectorXd fit = (part * scale.cwiseInverse().asDiagonal())
                                    .colPivHouseholderQr()
                                    .solve(Eigen::VectorXd::Ones(a.rows()))
                                    .cwiseQuotient(scale);
    Eigen::Index least = 0;
    if (fit.minCoeff(&least) >= 0) {
      x(kept) = fit;
      break;
    }
    kept.erase(kept.begin() + least);
  }
  return x;
}

/// Seconds per unit of one term that alone makes up a phase, of techniques that search ray by ray or of the others:
/// Σ seconds / Σ counts.
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
          .listed = 0,  // a part of the test: the fit cannot tell them apart
          .placement = 1.1e-7,
          .leaf = 1.1e-8,
          .sort = 1.1e-8,
          .cull = 9.0e-8};
}

UnitCosts fit_unit_costs(std::span<const TimedRun> runs) {
  constexpr Eigen::Index terms = 7;
  if (runs.size() < terms) throw std::invalid_argument("a fit of unit costs takes at least as many runs as costs");
  Eigen::MatrixXd a(static_cast<Eigen::Index>(runs.size()), terms);
  for (Eigen::Index row = 0; row < a.rows(); ++row) {
    const TimedRun& run = runs[static_cast<std::size_t>(row)];
    const Counts<double>& counts = run.counts;
    const bool index = record_of(run.technique).ray_by_ray;
    a.row(row) << counts.cull_tests, index ? 0 : counts.disc_tests, index ? counts.disc_tests : 0, counts.steps,
        counts.nodes, counts.listed, counts.culls;
    a.row(row) /= run.search;
  }
  const Eigen::VectorXd x = non_negative_fit(a);
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
