#pragma once

#include "choose.hpp"
#include "detp/validate/answer/fields.hpp"

/// The fields of `detp choose`, each listed once.
namespace detp::validate {

/// Of the whole answer: JSON, and the last columns of the table.
[[nodiscard]] const Fields<ChooseAnswer>& choose_fields();

/// Of a candidate: `candidates` in JSON, and the rows of the table.
[[nodiscard]] const Fields<ChooseRow>& choose_row_fields();

/// Of a candidate whose prediction is explained: `missed` in JSON.
[[nodiscard]] const Fields<ChooseRow>& missed_fields();

/// Of --ranks: `ranks` in JSON.
[[nodiscard]] const Fields<RanksAnswer>& ranks_fields();

}  // namespace detp::validate
