#pragma once

#include <optional>
#include <string>

namespace detp::sim {

/// The open descriptor that the path names: /dev/stdout, /dev/fd/3. Reopening /dev/stdout would start at the front of
/// the file that the shell has redirected it to, and overwrite its content.
[[nodiscard]] std::optional<int> descriptor_named(const std::string& path);

/// The path with links followed: to the file, or to the place where it will be created. None if links lead in a circle.
[[nodiscard]] std::optional<std::string> followed(const std::string& path);

/// Throws FileError with the system's reason if an OutputFile could not be written there. To be called before long
/// work. Creates and changes nothing. Does not open pipes: closing one again would signal end of file to its reader.
void require_writable(const std::string& path);

/// Whether both paths lead to one place, however they are spelled. /dev/null is never the same place as anything.
[[nodiscard]] bool same_place(const std::string& a, const std::string& b);

}  // namespace detp::sim
