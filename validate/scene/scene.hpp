#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "detp/validate/base/fields.hpp"
#include "detp/validate/job/job.hpp"

/// What is in a scene: what `detp scene` does.
namespace detp::validate {

struct SceneRequest {
  JobRequest job = {};
  std::optional<std::string> mesh_file = {};  ///< to write its triangles to, as PLY
  std::optional<std::string> disc_file = {};  ///< to write the discs to, as CSV, PLY or NPY
  std::optional<std::string> ray_file = {};   ///< to write the rays to, likewise
};

struct SceneAnswer {
  Job job = {};
  /// What switching an effect by hand changes: predicted tests of a tree of boxes with the effect switched, over those as
  /// they are. 0 for an effect that is a meaning of the input. In the order of the job's effects.
  std::vector<double> tests_if_switched = {};
  std::vector<std::string> remarks = {};     ///< what the user should know about the samples
  std::optional<sim::Stopped> stopped = {};  ///< what ended the writing of a file, which is not kept
};

/// Throws std::invalid_argument if triangles are to be written and there are none; as make_job, and as the writers of files.
[[nodiscard]] SceneAnswer answer(const SceneRequest& request, const std::stop_token& stop = {},
                                 const sim::ReportPhase& progress = {});

/// Tables have columns of the workload before these.
[[nodiscard]] const Fields<SceneAnswer>& scene_fields();

}  // namespace detp::validate
