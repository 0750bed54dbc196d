#pragma once

#include <string>
#include <variant>
#include <vector>

#include "awkward_scenes.hpp"
#include "detp/validate/choice/job.hpp"

/// The workloads on which choices are judged.
namespace detp::validate {

struct RegretWorkload {
  std::string scene;                              ///< name to show
  std::variant<std::string, AwkwardScene> discs;  ///< a built-in scene or a file to open, or discs to make
  sim::Field field = sim::Field::isotropic;
  double samples = 0;  ///< 0: one for each vertex
  double radius = 0;   ///< of the discs, share of the longest side
  double rays = 0;
  bool held_out = false;  ///< its scene was not used to set any number of a chooser
};

enum class RegretEffort {
  small,    ///< 24 workloads of at most 10⁴ rays and 10⁴ discs
  thorough  ///< all
};

/// The workloads, scene by scene. `folder` holds the meshes, all of which are held out; without it, the held-out scenes
/// are only some of those made by a program. Every scene has the radii 0.25, 1, 4 and 16 %; the numbers of rays, fields
/// and samples vary.
[[nodiscard]] std::vector<RegretWorkload> regret_workloads(RegretEffort effort, const std::string& folder);

/// The rays and discs. Throws as make_job does.
[[nodiscard]] Job make_regret_job(const RegretWorkload& workload, std::uint64_t seed, const std::stop_token& stop);

}  // namespace detp::validate
