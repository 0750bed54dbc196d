#include "output_place.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstring>
#include <string_view>

#include "file_error.hpp"
#include "number_text.hpp"
#include "output_file.hpp"

namespace detp::sim {
namespace {

constexpr int most_links = 40;

std::string folder_of(const std::string& place) {
  const std::string folder = place.substr(0, place.rfind('/') + 1);
  return folder.empty() ? "." : folder;
}

/// Identifies a place: by the device and number of the file there; if no file exists, by those of its folder and by its
/// name in this folder.
struct Identity {
  dev_t device = 0;
  ino_t file = 0;
  std::string name;

  bool operator==(const Identity&) const = default;
};

std::optional<Identity> identity(const std::string& path) {
  struct stat status {};
  const auto descriptor = descriptor_named(path);
  const int failed = descriptor ? ::fstat(*descriptor, &status) : ::stat(path.c_str(), &status);
  const bool nowhere = failed == 0 && S_ISCHR(status.st_mode) && status.st_rdev == makedev(1, 3);
  if (nowhere) return std::nullopt;
  if (failed == 0) return Identity{status.st_dev, status.st_ino, ""};
  const auto place = followed(path);
  if (!place || ::stat(folder_of(*place).c_str(), &status) != 0) return std::nullopt;
  return Identity{status.st_dev, status.st_ino, place->substr(place->rfind('/') + 1)};
}

}  // namespace

std::optional<int> descriptor_named(const std::string& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"})
    if (path.starts_with(folder))
      if (const auto number = number_in(std::string_view(path).substr(folder.size()));
          number && *number >= 0 && *number <= INT_MAX)
        return static_cast<int>(*number);
  return std::nullopt;
}

std::optional<std::string> followed(const std::string& path) {
  std::string place = path;
  for (int links = 0; links < most_links; ++links) {
    char target[PATH_MAX];
    const ssize_t length = ::readlink(place.c_str(), target, sizeof target);
    if (length < 0) return place;
    const std::string next(target, static_cast<std::size_t>(length));
    const std::size_t folder_end = place.rfind('/') + 1;  // 0 if the path has no folder
    place = next.starts_with('/') ? next : place.substr(0, folder_end) + next;
  }
  return std::nullopt;
}

void require_writable(const std::string& path) {
  const auto refuse = [&] { throw FileError(path, std::string("cannot be written: ") + std::strerror(errno)); };
  if (const auto descriptor = descriptor_named(path)) {
    const int flags = ::fcntl(*descriptor, F_GETFL);
    if (flags >= 0 && (flags & O_ACCMODE) == O_RDONLY) errno = EBADF;
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) refuse();
    return;
  }
  struct stat status {};
  const bool special = ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
  if (!special) return (void)OutputFile(path);
  if (::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) refuse();
}

bool same_place(const std::string& a, const std::string& b) {
  const auto first = identity(a);
  return first && first == identity(b);
}

}  // namespace detp::sim
