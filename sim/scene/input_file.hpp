#pragma once

#include <string>
#include <string_view>

namespace detp::sim {

/// The whole content of a file. Throws FileError with the system's reason: missing, unreadable, a directory.
[[nodiscard]] std::string read_file(const std::string& path);

/// Whether the path ends in `ending` (in lower case, such as ".ply"), in any case.
[[nodiscard]] bool has_ending(std::string_view path, std::string_view ending);

}  // namespace detp::sim
