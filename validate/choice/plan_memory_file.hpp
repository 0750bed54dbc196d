#pragma once

#include <string>

#include "plan_memory.hpp"

/// Remembered choices on disc, in JSON with the key of the machine and program that made them.
namespace detp::validate {

/// detp/plans.json in $XDG_CACHE_HOME, or in ~/.cache if that is not set to an absolute path; empty if there is no home
/// either.
[[nodiscard]] std::string default_plan_memory_path();

/// The content of the file.
[[nodiscard]] std::string plan_memory_text(const PlanMemory& memory);

/// Writes a file aside and renames it, so that other programs see the old or the new file. Makes the folder if necessary.
/// Throws sim::FileError. (If two programs write at once, the later file replaces the other.)
void write_plan_memory(const std::string& path, const PlanMemory& memory);

/// Adds the file's choices to the memory, by PlanMemory::remember. Returns a warning, or "" if all is well or there is no
/// such file. Uses nothing of a file that cannot be read, is broken, or belongs to another machine or program; the warning
/// says why. Never throws for what is in the file.
[[nodiscard]] std::string read_plan_memory(const std::string& path, PlanMemory& memory);

/// The same for the content of a file; `path` is for warnings.
[[nodiscard]] std::string parse_plan_memory(const std::string& text, const std::string& path, PlanMemory& memory);

}  // namespace detp::validate
