#pragma once

#include <string>

/// Files that detp keeps for later runs.
namespace detp::validate {

/// detp/NAME in $XDG_CACHE_HOME, or in ~/.cache if that is not set to an absolute path; empty if there is no home either.
[[nodiscard]] std::string cache_path(const std::string& name);

/// Replaces the file as a whole, and makes its folder if necessary. Throws sim::FileError.
void write_cache_file(const std::string& path, const std::string& text);

}  // namespace detp::validate
