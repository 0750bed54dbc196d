#pragma once

#include "detp/model/closed_form/technique_model.hpp"

/// The model of each technique.
namespace detp::model {

/// A function in the technique's file.
using DescribeTechnique = TechniqueModel();

/// The technique's model; without functions if the technique has no closed forms.
[[nodiscard]] const TechniqueModel& model_of(Technique technique);

/// Whether closed forms predict the technique's counts, so that it can be chosen without a run.
[[nodiscard]] inline bool has_closed_form(Technique technique) { return model_of(technique).predict != nullptr; }

}  // namespace detp::model
