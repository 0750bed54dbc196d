#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common_options.hpp"
#include "detp/sim/scene/selection.hpp"
#include "detp/validate/job/job.hpp"
#include "value_lists.hpp"

namespace detp::cli {

/// The options for rays and discs (or for a workload without a scene). The parser keeps pointers to this object.
class WorkloadOptions {
 public:
  WorkloadOptions() = default;
  WorkloadOptions(const WorkloadOptions&) = delete;
  WorkloadOptions& operator=(const WorkloadOptions&) = delete;

  /// `axes`: of --rays and --disc-radius, if other than that of the rest.
  void add_to(CLI::App& command, Values values = Values::one, std::optional<Values> axes = {});

  ValueLists lists;  ///< of the options that may have many values

  /// The request of the current row. Throws std::invalid_argument for options that exclude each other. If `complete`,
  /// also throws if a number of a workload without a scene is missing.
  [[nodiscard]] validate::JobRequest request(const CommonOptions& common, bool complete = true) const;

 private:
  validate::JobRequest request_;
};

/// Throws std::invalid_argument, naming the option, if a number of a workload without a scene is missing.
void require_numbers(const validate::JobRequest& request);

/// --material and --group.
void add_face_names(CLI::App& command, sim::FaceNames& names);

/// "area,spot". Throws std::invalid_argument for an unknown kind.
[[nodiscard]] double parse_crease(const std::string& text);
[[nodiscard]] std::vector<sim::LightKind> parse_lights(std::string_view text);

/// "-z"; nothing for "auto". Throws std::invalid_argument for other text.
[[nodiscard]] std::optional<sim::Up> parse_up(const std::string& text);

}  // namespace detp::cli
