#pragma once

#include <optional>
#include <string>

namespace detp::sim {

/// The open descriptor that the path is another name for: /dev/stdout, /dev/fd/3. Opened again, /dev/stdout would start
/// at the front of the file that the shell has directed it to, and overwrite what is there.
[[nodiscard]] std::optional<int> descriptor_named(const std::string& path);

/// The path with links followed: to the file, or to the place where it is to be. None for links that lead in a circle.
[[nodiscard]] std::optional<std::string> followed(const std::string& path);

/// Throws FileError with the system's reason where an OutputFile could not be written there: to be called before long
/// work. Creates nothing, changes nothing; opens no pipe, whose reader would take it for the end.
void require_writable(const std::string& path);

/// Whether both paths lead to one place, however they are spelled. Nothing is the same place as /dev/null.
[[nodiscard]] bool same_place(const std::string& a, const std::string& b);

}  // namespace detp::sim
