#pragma once

#include <string>

#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/run/run.hpp"

namespace detp::cli {

/// A line about the picture.
[[nodiscard]] std::string picture_text(const validate::Picture& picture, const validate::SeenBetween& seen,
                                       const Screen& screen);

/// The answer of `detp run` in text. `measured`: of the whole command. `verbose`: also the effects, and the table of counts. Without it, nothing of the job is measured.
[[nodiscard]] std::string to_text(const validate::Job& job, const validate::RunAnswer& answer,
                                  const validate::Whole& measured, const Screen& screen, bool verbose);

}  // namespace detp::cli
