#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/choice/candidate_json.hpp"
#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/job/job.hpp"

/// Rays, discs and techniques in JSON and text.
namespace detp::cli {

/// "isotropic" or "photons".
[[nodiscard]] std::string_view name(sim::Field field);

/// An array of their names.
[[nodiscard]] Json names_json(const std::vector<Technique>& techniques);

/// The parameters under their names, with underscores.
[[nodiscard]] Json to_json(const Workload& workload);

/// Resolved inputs of a workload without a scene.
[[nodiscard]] Json numbers_json(const Workload& workload);

/// A count for JSON, written without a decimal point.
[[nodiscard]] inline Json whole(double count) { return static_cast<std::int64_t>(count); }
template <class T>
[[nodiscard]] Json to_json(const Counts<T>& counts) {
  Json json;
  for_each_term(counts, [&](std::string_view term, T value) { json[std::string(term)] = value; });
  return json;
}

/// The resolved inputs that say where discs and rays come from; file names as the user wrote them.
[[nodiscard]] Json origin_json(const validate::JobRequest& request, const std::string& scene, sim::Field field);

/// Resolved inputs of a job; file names as the user wrote them.
[[nodiscard]] Json to_json(const validate::Job& job, const validate::JobRequest& request);

/// Where light and faces went.
[[nodiscard]] Json light_json(const sim::LightLedger& light);
[[nodiscard]] Json geometry_json(const sim::PolygonCounts& polygons, std::uint64_t normals_made,
                                 std::uint64_t coincident);

/// `light`, where photons were traced, and `geometry` of a scene.
[[nodiscard]] Json ledgers_json(const validate::Job& job);

/// The notices and warnings of the job, as notes.
void note_all(const CommonOptions& common, const validate::Job& job);

/// The lines "scene" and "rays" of the text output; these with the light that left or was cut, if that is much.
[[nodiscard]] std::string describe(const validate::Job& job);

/// Rays of a job's kind that a run has taken.
struct RaysTaken {
  double rays = 0;
  double photons = 0;
  std::optional<sim::LightLedger> light = {};  ///< of photons that were traced for it
};

/// The same without what has to be measured; `taken`: other rays than the job's own. Without rays: the scene and its lights.
[[nodiscard]] std::string describe_given(const validate::Job& job, const std::optional<RaysTaken>& taken = {});

/// "1 thread", "2 threads".
[[nodiscard]] std::string threads_text(int threads);

}  // namespace detp::cli
