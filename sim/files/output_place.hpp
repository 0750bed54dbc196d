#pragma once

#include <optional>
#include <string>

namespace detp::sim {

/// The descriptor that the path names, such as /dev/stdout or /dev/fd/3; nullopt for all other paths. Writers must use
/// the descriptor itself: if the shell has redirected /dev/stdout to a file, reopening /dev/stdout would start at the
/// front of this file and overwrite its content.
[[nodiscard]] std::optional<int> descriptor_named(const std::string& path);

/// The path with links followed, to the file or to where it will be created. Nullopt if links lead in a circle (40
/// links or more).
[[nodiscard]] std::optional<std::string> followed(const std::string& path);

/// Throws FileError with the system's reason if an OutputFile could not be written there. To be called before long
/// work. Changes nothing and leaves no file. Does not open pipes: closing a pipe would signal end of file to a reader.
void require_writable(const std::string& path);

/// Whether both paths lead to the same place, however they are spelled. False for /dev/null, even twice.
[[nodiscard]] bool same_place(const std::string& a, const std::string& b);

}  // namespace detp::sim
