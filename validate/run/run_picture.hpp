#pragma once

#include <stop_token>
#include <string>

#include "run.hpp"

namespace detp::validate {

/// Writes the picture; returns its view. Throws as write_files, and sim::Stopped.
[[nodiscard]] SeenBetween write_picture(const Picture& picture, const Job& job, const RunAnswer& answer,
                                        const std::stop_token& stop);

}  // namespace detp::validate
