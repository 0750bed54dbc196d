#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "detp/sim/technique/disc_order.hpp"
#include "plan.hpp"

namespace detp::validate {

/// What a plan and its replans share.
struct Plan::Basis {
  PlanOptions options;                                      ///< without stop and progress
  sim::Problem problem;                                     ///< without rays
  double radius;                                            ///< of the discs, root mean square
  double rays;                                              ///< number of rays for which the plan was made
  std::vector<Prediction> candidates = {};                  ///< not empty, the plan's first
  std::optional<Workload> workload = {};                    ///< for closed forms; set if the plan was made by these
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

/// Of rays, discs and a first search of them.
[[nodiscard]] inline double bytes_in_memory(double rays, std::size_t discs, double bytes_touched) {
  return sizeof(sim::Ray) * rays + sizeof(sim::Disc) * static_cast<double>(discs) + bytes_touched;
}

}  // namespace detp::validate
