#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "detp/validate/job/job.hpp"

/// The workloads on which choices are judged.
namespace detp::validate {

enum class AwkwardScene {
  clusters,     ///< in 20 clusters of very different sizes in a cube
  tiny_object,  ///< half on a floor, half on a ball with a hundredth of the floor's side as diameter
  thin_sheet,   ///< in a plane
  strays,       ///< uniform in a cube, but five of them 300 times the cube's side away
  mixed_radii   ///< uniform in a cube, with log-normal radii: a factor of e is one standard deviation
};

/// "tiny-object".
[[nodiscard]] std::string_view name(AwkwardScene scene);

/// `count` discs with isotropic normals. `radius` is the (median) disc radius; the longest side of the cube, floor or
/// sheet is 1. Each disc is a function of the seed and of its number.
[[nodiscard]] std::vector<sim::Disc> awkward_discs(AwkwardScene scene, std::size_t count, double radius,
                                                   std::uint64_t seed);

struct RegretWorkload {
  std::string scene;                              ///< name to show: "@tree", "sponza", "thin-sheet"
  std::variant<std::string, AwkwardScene> discs;  ///< a built-in scene or a file to open, or discs to make
  sim::Field field = sim::Field::isotropic;
  double samples = 0;  ///< 0: one for each vertex
  double radius = 0;   ///< of the discs, share of the longest side
  double rays = 0;
  bool held_out = false;  ///< its scene was not used to set any number of a chooser
  sim::EffectSelection effects = {};
};

enum class RegretEffort {
  quick,    ///< workloads of 10³ and 10⁴ rays and at most 10⁴ discs; no meshes
  thorough  ///< all
};

struct RegretSet {
  std::vector<RegretWorkload> workloads;
  std::vector<std::string> missing;  ///< the name of each mesh that was left out, and why
};

/// The workloads, scene by scene, first those that are not held out. `folder` holds the meshes, all of which are held
/// out; empty if unknown. Every scene has the radii 0.25, 1, 4 and 16 % of its longest side; the numbers of rays, fields
/// and samples vary. Workloads with more than about 3·10⁷ hits are left out, and so are 10⁶ rays on large discs.
[[nodiscard]] RegretSet regret_set(RegretEffort effort, const std::string& folder);

/// 84 workloads in 12 scenes, two of each family (sim/scene/families): photon paths and lines, radii from 0.25 to 16 % of the scene and 10² to 10⁶
/// rays, log-uniform at random; at most about 3·10⁷ hits. All are held out if nobody has looked at results of this seed.
[[nodiscard]] std::vector<RegretWorkload> family_workloads(std::uint64_t seed);

/// The rays and discs. Throws as make_job does.
[[nodiscard]] Job make_regret_job(const RegretWorkload& workload, std::uint64_t seed, const std::stop_token& stop);

}  // namespace detp::validate
