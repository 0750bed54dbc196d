#pragma once

#include <string>

#include "choose_report.hpp"

namespace detp::cli {

/// The line "rival": the technique next to the choice, and how much slower it is or why it is ruled out. Then the
/// techniques that were not examined. After a measurement, the fastest candidate of another technique.
[[nodiscard]] std::string rival_line(const ChooseAnswer& answer);

}  // namespace detp::cli
