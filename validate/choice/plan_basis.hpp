#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "detp/sim/technique/disc_order.hpp"
#include "plan.hpp"

namespace detp::validate {

/// A candidate of a plan, as the first plan predicted it.
struct PlanCandidate {
  Candidate candidate;
  double seconds;
  double error;  ///< standard error of the seconds
  int threads = 1;
  double doubt = 1;                ///< it is compared as if it took so many times as long
  double closed_form_seconds = 0;  ///< by its closed form, for the basis's workload; 0: there is none
  /// its counts with another radius and number of rays, as Piloted::counts_at; may be empty
  std::function<Counts<double>(double radius_ratio, double rays)> counts_at = {};
};

/// What a plan and its replans share.
struct Plan::Basis {
  PlanOptions options;                                      ///< without stop and progress
  sim::Problem problem;                                     ///< without rays
  double radius;                                            ///< of the discs, root mean square
  double rays;                                              ///< number of rays for which the plan was made
  std::vector<PlanCandidate> candidates = {};               ///< not empty
  std::optional<Workload> workload = {};                    ///< for candidates without counts_at
  std::optional<sim::DiscOrder> order = {};                 ///< if it is known
  std::shared_ptr<const std::vector<sim::Disc>> own_discs;  ///< of the problem; null if the discs are borrowed
};

/// Builds the index of the candidate; along the known order, if there is one and the candidate is a box tree.
[[nodiscard]] std::unique_ptr<sim::Index> build_index(const sim::Problem& problem, const Candidate& candidate,
                                                      const std::optional<sim::DiscOrder>& order,
                                                      const sim::RunOptions& options);

/// The least ratio of times of any search and its preparation, with radii and numbers of rays of these ratios. Tests are
/// proportional to areas, and discs in cells to volumes, of bodies that are grown by the radius: these are polynomials of
/// the radius, of the second and third degree, without negative coefficients (Steiner's formula).
[[nodiscard]] double least_time_ratio(double radius_ratio, double rays_ratio);

}  // namespace detp::validate
