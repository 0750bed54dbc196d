#pragma once

#include <optional>
#include <string>

#include "answer_rows.hpp"
#include "detp/validate/whole/whole.hpp"

/// The whole wait and the memory of a command, predicted and measured.
namespace detp::cli {

struct Whole {
  validate::WholeSeconds seconds;
  std::optional<double> peak_bytes;
};

/// `read`, `trace`, `prepare`, `search`, `total`; the total also has the start of the program and writing.
[[nodiscard]] Json whole_json(const validate::WholeSeconds& seconds);

/// "whole     0.41 s: reading 0.12, …; 121 MB", with predictions beside what was measured, as "0.41 s (predicted 0.38)".
[[nodiscard]] std::string whole_line(const std::optional<Whole>& predicted, const std::optional<Whole>& measured);

}  // namespace detp::cli
