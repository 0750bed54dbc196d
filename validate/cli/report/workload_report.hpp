#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/answer/parts.hpp"
#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/job/job.hpp"

/// Rays, discs and techniques in text.
namespace detp::cli {

using validate::geometry_json;
using validate::light_json;
using validate::name;
using validate::names_json;
using validate::numbers_json;
using validate::origin_json;
using validate::to_json;
using validate::whole;

/// The notices and warnings of the job, as notes.
void note_all(const CommonOptions& common, const validate::Job& job);

/// The lines "scene" and "rays" of the text output; these with the light that left or was cut, if that is much.
[[nodiscard]] std::string describe(const validate::Job& job);

/// The same without what has to be measured; `taken`: other rays than the job's own. Without rays: the scene and its lights.
[[nodiscard]] std::string describe_given(const validate::Job& job,
                                         const std::optional<validate::RaysTaken>& taken = {});

/// "1 thread", "2 threads".
[[nodiscard]] std::string threads_text(int threads);

}  // namespace detp::cli
