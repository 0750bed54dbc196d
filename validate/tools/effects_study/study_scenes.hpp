#pragma once

#include <string>
#include <variant>
#include <vector>

#include "detp/validate/regret/regret_workloads.hpp"

/// The scenes of the study of effects.
namespace detp::study {

struct StudyScene {
  std::string name;
  std::variant<std::string, validate::AwkwardScene> discs;  ///< as in RegretWorkload
  bool light = false;                                       ///< photon paths, too
  /// thresholds of effects were selected on it, or the smallest node of clustered samples
  bool tuned = false;
};

/// Built-in scenes, generated discs, and every mesh in the folder and the folders in it.
[[nodiscard]] std::vector<StudyScene> study_scenes(const std::string& folder);

/// The scene with these rays, in each of its fields.
[[nodiscard]] std::vector<validate::RegretWorkload> with_fields(const StudyScene& scene, double radius, double rays);

}  // namespace detp::study
