#pragma once

namespace detp::cli {

/// Seconds since the program was loaded.
[[nodiscard]] double seconds_since_start();

}  // namespace detp::cli
