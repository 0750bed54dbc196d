#include "output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "file_error.hpp"
#include "number_text.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t buffer_size = 1 << 16;

/// The open descriptor that the path is another name for. Opened anew, /dev/stdout would start at the front of the file
/// that the shell has directed it to, and overwrite what is there.
std::optional<int> descriptor_named(std::string_view path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"})
    if (path.starts_with(folder))
      if (const auto number = number_in(path.substr(folder.size())); number && *number >= 0 && *number <= INT_MAX)
        return static_cast<int>(*number);
  return std::nullopt;
}

/// The path with links followed as far as they lead: to the file, or to the place where it is to be.
std::string followed(const std::string& path) {
  std::string place = path;
  for (int links = 0; links < 40; ++links) {
    char target[PATH_MAX];
    const ssize_t length = ::readlink(place.c_str(), target, sizeof target);
    if (length < 0) break;
    const std::string next(target, static_cast<std::size_t>(length));
    const std::size_t folder_end = place.rfind('/') + 1;  // 0 where there is none
    place = next.starts_with('/') ? next : place.substr(0, folder_end) + next;
  }
  return place;
}

/// A name in the same folder that no other writer, here or in another process, takes.
std::string name_beside(const std::string& target) {
  static std::atomic<unsigned> last{0};
  const std::string folder = target.substr(0, target.rfind('/') + 1);
  return folder + ".detp-" + std::to_string(::getpid()) + "-" + std::to_string(++last) + ".part";
}

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path) {
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (const auto descriptor = descriptor_named(path)) {
    descriptor_ = ::dup(*descriptor);
    if (descriptor_ < 0) fail("cannot be written");
  } else if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail("cannot be written");
  } else {
    // Renaming would replace even a file that must not be written.
    if (exists && ::access(path.c_str(), W_OK) != 0) fail("cannot be written");
    open_aside();
    if (exists && ::fchmod(descriptor_, status.st_mode & 07777) != 0) fail("cannot be written");
  }
  buffer_.reserve(buffer_size);
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::open_aside() {
  target_ = followed(path_);
  do {
    aside_ = name_beside(target_);
    descriptor_ = ::open(aside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ >= 0) return;
  aside_.clear();
  fail("cannot be written");
}

void OutputFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= buffer_size) flush();
}

void OutputFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno != EINTR) fail("cannot be written");
    if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

void OutputFile::commit() {
  flush();
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail("cannot be written");
  if (aside_.empty()) return;
  if (std::rename(aside_.c_str(), target_.c_str()) != 0) fail("cannot be put in its place");
  aside_.clear();
}

void OutputFile::discard() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  if (!aside_.empty()) ::unlink(aside_.c_str());
  aside_.clear();
}

void OutputFile::fail(const std::string& what) {
  const std::string reason = std::strerror(errno);
  discard();
  throw FileError(path_, what + ": " + reason);
}

}  // namespace detp::sim
