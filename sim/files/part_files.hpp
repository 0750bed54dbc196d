#pragma once

#include <string>

/// Files that are being written aside under a name of their own, known to the whole program, so that they can be
/// removed when it has to end at once.
namespace detp::sim {

/// Creates a file in the folder of `target`, for writing; returns its descriptor, or -1 with errno set.
[[nodiscard]] int create_part_file(const std::string& target, std::string& name);

/// Gives the open file without a name one beside `target`, as a part file. False with errno set where that fails.
[[nodiscard]] bool name_part_file(int descriptor, const std::string& target, std::string& name);

/// Puts the part file in the target's place. False with errno set where that fails: it is then a part file still.
[[nodiscard]] bool finish_part_file(const std::string& name, const std::string& target);

void remove_part_file(const std::string& name);

/// Removes all part files, and lets no new ones arise: to be called from any thread that is about to end the program at
/// once (not from a signal handler).
void remove_all_part_files_for_good() noexcept;

}  // namespace detp::sim
