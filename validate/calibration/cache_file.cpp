#include "cache_file.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/output_file.hpp"

namespace detp::validate {

std::string cache_path(const std::string& name) {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && value[0] == '/' ? std::filesystem::path(value) : std::filesystem::path();
  };
  std::filesystem::path cache = folder("XDG_CACHE_HOME");
  if (cache.empty() && !folder("HOME").empty()) cache = folder("HOME") / ".cache";
  return cache.empty() ? "" : (cache / "detp" / name).string();
}

void write_cache_file(const std::string& path, const std::string& text) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) throw sim::FileError(folder.string(), fmt::format("cannot be made: {}", failed.message()));
  sim::OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace detp::validate
