#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/validate/cli/text/result.hpp"

/// The parts of the answer of `detp report`: what is run for each, and what follows from all of them.
namespace detp::cli {

struct ReportOptions {
  std::string scene;
  std::optional<double> rays;
  std::optional<std::string> radius;
  std::optional<double> samples;
  std::optional<std::string> lights;
  std::optional<std::string> up;
  std::optional<std::string> error;  ///< --target-error
  std::optional<std::string> noise;  ///< --target-noise
  bool front_facing = false;
  bool quick = false;
  std::vector<std::string> common = {};  ///< words for every part: --seed, --threads
};

/// A command of this program.
struct ReportPart {
  std::string name;
  std::vector<std::string> words;  ///< of the command line
  double forecast = 0;             ///< seconds
  bool may_fail = false;           ///< the scene may have no such answer

  /// As a shell takes it.
  [[nodiscard]] std::string line() const;
};

/// What the forecasts need; from the first part, `scene`.
struct ReportScale {
  double triangles = 0;
  double samples = 0;
  double rays = 0;
  double disc_radius = 0;
  double reading_seconds = 0;  ///< of the scene
  double tracing_seconds = 0;  ///< of the rays
};

[[nodiscard]] ReportPart scene_part(const ReportOptions& options);
[[nodiscard]] ReportScale scale_of(const Json& scene_answer);

/// The parts after `scene`, in the order of what the page can least do without: choice, accuracy, map, verdicts.
[[nodiscard]] std::vector<ReportPart> report_parts(const ReportOptions& options, const ReportScale& scale);

/// The member `answer` of the report, from its member `parts`.
[[nodiscard]] Json report_answer(const Json& report);

}  // namespace detp::cli
