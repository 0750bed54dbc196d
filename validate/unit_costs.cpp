#include "unit_costs.hpp"

#include <Eigen/Dense>
#include <array>
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

/// Seconds per unit of one term that alone makes up a phase: Σ seconds / Σ counts.
double simple_rate(std::span<const TimedRun> runs, double TimedRun::*seconds, double Counts<double>::*term) {
  double time = 0;
  double count = 0;
  for (const TimedRun& run : runs) {
    time += run.counts.*term > 0 ? run.*seconds : 0;
    count += run.counts.*term;
  }
  return count > 0 ? time / count : 0;
}

}  // namespace

UnitCosts built_in_unit_costs() {
  return {.sphere_test = 4.3e-9,
          .disc_test = 2.2e-9,
          .step = 2.0e-8,
          .node = 1.3e-7,
          .copy = 1.0e-8,
          .placement = 2.4e-7,
          .sort = 2.6e-8,
          .rebuild = 8.5e-9};
}

UnitCosts fit_unit_costs(std::span<const TimedRun> runs) {
  using C = Counts<double>;
  constexpr std::array terms{&C::sphere_tests, &C::disc_tests, &C::steps, &C::nodes, &C::copies, &C::rebuilds};
  if (runs.size() < terms.size())
    throw std::invalid_argument("a fit of unit costs takes at least as many runs as costs");
  Eigen::MatrixXd a(static_cast<Eigen::Index>(runs.size()), static_cast<Eigen::Index>(terms.size()));
  for (std::size_t row = 0; row < runs.size(); ++row)
    for (std::size_t column = 0; column < terms.size(); ++column)
      a(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
          runs[row].counts.*terms[column] / runs[row].search;
  const Eigen::VectorXd x = non_negative_fit(a);
  return {.sphere_test = x[0],
          .disc_test = x[1],
          .step = x[2],
          .node = x[3],
          .copy = x[4],
          .placement = simple_rate(runs, &TimedRun::build, &C::placements),
          .sort = simple_rate(runs, &TimedRun::order, &C::sorted),
          .rebuild = x[5]};
}

}  // namespace detp::validate
