#pragma once

#include <string>
#include <vector>

#include "detp/validate/job/job.hpp"

/// The workloads on which the paper's rule is judged.
namespace detp::zones {

/// The regions of the paper's rule: X <= 2, between, X >= 6. X = mean distance between samples / disc radius.
inline constexpr double least_x = 0.25;
inline constexpr double index_up_to = 2;
inline constexpr double cache_from = 6;
inline constexpr double most_x = 24;

struct ZoneWorkload {
  std::string name;   ///< of the scene, to show
  std::string scene;  ///< a built-in scene or a file
  sim::Field field = sim::Field::photons;
  double x = 0;
  double rays = 0;
};

/// Nine in each of 13 scenes, three for each region of the rule; without the folder of the meshes, in 11 scenes. X and the
/// number of rays, 100 to 409 600 as in the paper, are log-uniform at random; at most about 2·10⁷ hits. Of the three, two
/// have photon paths, and one has lines.
[[nodiscard]] std::vector<ZoneWorkload> zone_workloads(const std::string& folder, std::uint64_t seed);

/// Its rays and discs. Throws as make_job does.
[[nodiscard]] validate::Job make_zone_job(const ZoneWorkload& workload);

}  // namespace detp::zones
