#pragma once

#include <string>

/// Part files: files being written under a temporary name. The program keeps a list of all part files, so that it can
/// remove them when it has to end at once.
namespace detp::sim {

/// Creates a part file in the folder of `target`; sets `name` to its path. Returns a descriptor, or -1 with errno set.
[[nodiscard]] int create_part_file(const std::string& target, std::string& name);

/// Gives an open file without a name a new name in the folder of `target`, and adds it to the part files. Sets `name`
/// to its path. On failure returns false with errno set.
[[nodiscard]] bool name_part_file(int descriptor, const std::string& target, std::string& name);

/// Moves the part file to the target. On failure returns false with errno set; the file is then still a part file.
[[nodiscard]] bool finish_part_file(const std::string& name, const std::string& target);

void remove_part_file(const std::string& name);

/// Removes all part files. Later calls that would create, finish or remove a part file wait forever. To be called from
/// any thread that is about to end the program at once (not from a signal handler).
void remove_all_part_files_for_good() noexcept;

}  // namespace detp::sim
