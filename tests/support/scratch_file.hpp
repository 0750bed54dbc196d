#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "detp/sim/files/file_error.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/geometry/random.hpp"

/// Files for tests of readers and writers.
namespace detp::support {

/// A temporary folder, which the destructor removes.
class ScratchFolder {
 public:
  ScratchFolder() {
    const std::string folder = std::filesystem::temp_directory_path().string();
    // Tests split lines at blanks, and print paths on lines of limited width.
    std::string name =
        (folder.size() > 50 || folder.find(' ') != std::string::npos ? "/tmp" : folder) + "/detp-test-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder in " + folder);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] std::string path(const std::string& name) const { return (path_ / name).string(); }

  /// Writes the file and returns its path.
  std::string file(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }

  [[nodiscard]] std::size_t entries() const {
    const std::filesystem::directory_iterator begin(path_);
    return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
  }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The message of the sim::FileError that the call throws; "" if it throws none.
inline std::string file_error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const sim::FileError& error) {
    return error.what();
  }
  return {};
}

/// Checks that each content is refused with a message that contains `prefix` and its own part. `error_of` gives the message.
inline void check_errors(const std::vector<std::pair<std::string, std::string>>& contents_and_parts,
                         const std::function<std::string(const std::string&)>& error_of,
                         const std::string& prefix = "") {
  for (const auto& row : contents_and_parts) {
    CAPTURE(row.first.substr(0, 200));
    const std::string message = error_of(row.first);
    CHECK_MESSAGE(message.find(prefix + row.second) != std::string::npos, message);
  }
}

/// Calls `read` with the content truncated at every length, and with `flips` random changes of 1 to 4 bytes each.
/// `read` may throw sim::FileError, but nothing else. Returns how many of the damaged files it refused.
inline std::size_t refused_when_damaged(const std::string& name, const std::string& content, std::uint64_t flips,
                                        const std::function<void(const std::string& path)>& read) {
  const ScratchFolder folder;
  std::size_t refused = 0;
  const auto try_it = [&](const std::string& damaged) {
    std::filesystem::remove(folder.path(name));  // faster than overwriting it
    const std::string path = folder.file(name, damaged);
    try {
      read(path);
    } catch (const sim::FileError&) {
      ++refused;
    }
  };
  for (std::size_t length = 0; length < content.size(); ++length) try_it(content.substr(0, length));
  for (std::uint64_t flip = 0; flip < flips; ++flip) {
    std::string damaged = content;
    const std::uint64_t changes = 1 + sim::bits4(1, sim::Stream::tests, flip)[0] % 4;
    for (std::uint64_t change = 1; change <= changes; ++change) {
      const auto bits = sim::bits4(1, sim::Stream::tests, flip, change);
      damaged[bits[0] % damaged.size()] = static_cast<char>(bits[1] & 0xff);
    }
    try_it(damaged);
  }
  return refused;
}

/// The folder of the test scenes; "", with a message, if the environment does not name it.
inline std::string scenes_folder() {
  const char* folder = std::getenv("DETP_SCENES");
  if (folder == nullptr) MESSAGE("skipped: DETP_SCENES is not set");
  return folder == nullptr ? "" : folder;
}

/// The content of a binary PLY file of discs, little-endian doubles.
inline std::string disc_ply(std::span<const sim::Disc> discs) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(discs.size()) + "\n";
  for (const char* const name : {"x", "y", "z", "nx", "ny", "nz", "radius"})
    text += std::string("property double ") + name + "\n";
  text += "end_header\n";
  for (const sim::Disc& disc : discs) {
    const double numbers[] = {disc.centre.x, disc.centre.y, disc.centre.z, disc.normal.x,
                              disc.normal.y, disc.normal.z, disc.radius};
    text.append(reinterpret_cast<const char*>(numbers), sizeof(numbers));
  }
  return text;
}

}  // namespace detp::support
