#include "non_negative_fit.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <stdexcept>
#include <utility>

namespace detp::validate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// An x >= 0, and the list of unknowns that are free to be positive.
struct Fit {
  VectorXd x;
  std::vector<Index> free;
};

/// The least-squares fit of the free unknowns, whatever their signs; all other unknowns are 0.
VectorXd joint_fit(const MatrixXd& a, const VectorXd& b, const std::vector<Index>& free) {
  VectorXd x = VectorXd::Zero(a.cols());
  if (!free.empty()) x(free) = a(Eigen::all, free).colPivHouseholderQr().solve(b);
  return x;
}

/// Moves from x to the joint fit of the free unknowns. An unknown that becomes 0 on the way stays 0 and is no longer
/// free; the move then goes on to the joint fit of the others.
void move_to_joint_fit(const MatrixXd& a, const VectorXd& b, Fit& fit) {
  for (;;) {
    const VectorXd goal = joint_fit(a, b, fit.free);
    auto first = fit.free.end();  // the first unknown to become 0
    double step = 1;
    for (auto i = fit.free.begin(); i != fit.free.end(); ++i) {
      if (goal[*i] > 0) continue;
      const double reach = fit.x[*i] > 0 ? fit.x[*i] / (fit.x[*i] - goal[*i]) : 0;
      if (first != fit.free.end() && reach >= step) continue;
      first = i;
      step = reach;
    }
    if (first == fit.free.end()) {
      fit.x = goal;
      return;
    }
    fit.x += step * (goal - fit.x);
    fit.x[*first] = 0;
    fit.free.erase(first);
  }
}

/// Requires columns of length 1.
VectorXd fit_unit_columns(const MatrixXd& a, const VectorXd& b) {
  Fit best{VectorXd::Zero(a.cols()), {}};
  double error = b.norm();
  const double tolerance = 1e-13 * error;
  for (;;) {
    VectorXd gain = a.transpose() * (b - a * best.x);
    for (const Index i : best.free) gain[i] = 0;
    Index entering = 0;
    if (!(gain.maxCoeff(&entering) > tolerance)) return best.x;
    Fit next = best;
    next.free.push_back(entering);
    move_to_joint_fit(a, b, next);
    const double next_error = (b - a * next.x).norm();
    if (!(next_error < error)) return best.x;  // each step lowers the error, except for rounding
    error = next_error;
    best = std::move(next);
  }
}

}  // namespace

std::vector<double> non_negative_fit(std::span<const double> a, std::size_t unknowns, std::span<const double> b) {
  if (unknowns == 0 || a.size() != unknowns * b.size())
    throw std::invalid_argument(fmt::format(
        "a fit of {} unknowns to {} numbers takes a matrix of their product (got {})", unknowns, b.size(), a.size()));
  using RowByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto rows = static_cast<Index>(b.size());
  MatrixXd matrix = Eigen::Map<const RowByRow>(a.data(), rows, static_cast<Index>(unknowns));
  const VectorXd right = Eigen::Map<const VectorXd>(b.data(), rows);
  if (!matrix.allFinite() || !right.allFinite())
    throw std::invalid_argument("a fit takes finite numbers (got infinity or not a number)");
  VectorXd lengths = matrix.colwise().norm();
  lengths = (lengths.array() > 0).select(lengths, 1);
  matrix *= lengths.cwiseInverse().asDiagonal();
  const VectorXd x = fit_unit_columns(matrix, right).cwiseQuotient(lengths);
  return {x.begin(), x.end()};
}

}  // namespace detp::validate
