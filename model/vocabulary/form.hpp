#pragma once

#include <string_view>

namespace detp::model {

/// Which version of a formula: as the paper printed it, or as derivation and simulation say it should be.
enum class Form { published, corrected };

[[nodiscard]] constexpr std::string_view name(Form form) { return form == Form::published ? "published" : "corrected"; }

}  // namespace detp::model
