#include "output_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <utility>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "file_error.hpp"
#include "output_place.hpp"
#include "part_files.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t buffer_size = 1 << 16;
constexpr int reader_milliseconds = 20;      // time between two checks for a stop request
constexpr double seconds_for_reader = 0.15;  // after a stop request

/// Throws Stopped if a stop was requested and the reader has been waited for so long since.
class Patience {
 public:
  Patience(const std::string& path, const std::stop_token& stop) : path_(path), stop_(stop) {}

  void check() {
    if (!stop_.stop_requested())
      since_stop_ = {};
    else if (since_stop_.seconds() >= seconds_for_reader)
      throw Stopped("stopped while writing " + shown_path(path_) + ": nobody reads it");
  }

 private:
  const std::string& path_;
  const std::stop_token& stop_;
  Stopwatch since_stop_;
};

/// Opens a file without a name in the target's folder. Returns -1 if the file system does not support such files, or if
/// the file could not be named later (no /proc).
int open_unnamed(const std::string& target) {
  const std::string folder = target.substr(0, target.rfind('/') + 1);
  if (::access("/proc/self/fd", X_OK) != 0) return -1;
  return ::open(folder.empty() ? "." : folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
}

}  // namespace

OutputFile::OutputFile(const std::string& path, std::stop_token stop, Temporary temporary)
    : path_(path), stop_(std::move(stop)) {
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (const auto descriptor = descriptor_named(path)) {
    descriptor_ = ::dup(*descriptor);
    if (descriptor_ < 0) fail("cannot be written");
  } else if (exists && !S_ISREG(status.st_mode)) {
    open_pipe();
  } else {
    // A rename would replace even a write-protected file, so check first.
    if (exists && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) fail("cannot be written");
    open_temporary(temporary);
    if (exists && ::fchmod(descriptor_, status.st_mode & 07777) != 0) fail("cannot be written");
  }
  buffer_.reserve(buffer_size);
  may_wait_ = target_.empty() && ::fstat(descriptor_, &status) == 0 && !S_ISREG(status.st_mode);
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::open_temporary(Temporary temporary) {
  const auto target = followed(path_);
  if (!target) errno = ELOOP;
  if (!target) fail("cannot be written");
  target_ = *target;
  struct stat status {};
  if (::lstat(target_.c_str(), &status) != 0 && (errno != ENOENT || target_.empty())) fail("cannot be written");
  if (temporary == Temporary::unnamed) descriptor_ = open_unnamed(target_);
  if (descriptor_ < 0) descriptor_ = create_part_file(target_, part_);
  if (descriptor_ >= 0) return;
  part_.clear();
  fail("cannot be written");
}

void OutputFile::open_pipe() {
  Patience patience(path_, stop_);
  struct stat status {};
  for (;;) {
    // With O_NONBLOCK, a pipe that nobody reads yet is an error. Without, opening it would block.
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ >= 0) return;
    const int error = errno;
    const bool unread = error == ENXIO && ::stat(path_.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
    errno = error;
    if (!unread && error != EINTR) fail("cannot be written");
    ::poll(nullptr, 0, reader_milliseconds);
    patience.check();
  }
}

void OutputFile::wait_for_reader() {
  Patience patience(path_, stop_);
  pollfd wanted{.fd = descriptor_, .events = POLLOUT, .revents = 0};
  while (::poll(&wanted, 1, reader_milliseconds) <= 0) patience.check();
}

void OutputFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= buffer_size) flush();
}

void OutputFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    if (may_wait_) wait_for_reader();
    // A pipe that a reader has taken something from has room for PIPE_BUF bytes: writing so many does not block.
    const std::size_t size = may_wait_ ? std::min<std::size_t>(rest.size(), PIPE_BUF) : rest.size();
    const ssize_t count = ::write(descriptor_, rest.data(), size);
    if (count < 0 && errno != EINTR && errno != EAGAIN) fail("cannot be written");
    if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

void OutputFile::commit() {
  flush();
  if (!target_.empty() && part_.empty()) name_unnamed();
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail("cannot be written");
  if (part_.empty()) return;
  if (!finish_part_file(part_, target_)) fail("cannot be put in its place");
  part_.clear();
}

/// Gives the nameless file its name. If the name is taken, the file becomes a part file first, because only a rename
/// can replace a file.
void OutputFile::name_unnamed() {
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor_);
  if (::linkat(AT_FDCWD, link.c_str(), AT_FDCWD, target_.c_str(), AT_SYMLINK_FOLLOW) == 0) return;
  if (errno == EEXIST && name_part_file(descriptor_, target_, part_)) return;
  part_.clear();
  fail("cannot be put in its place");
}

void OutputFile::discard() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  if (!part_.empty()) remove_part_file(part_);
  part_.clear();
}

void OutputFile::fail(const std::string& what) {
  const std::string reason = std::strerror(errno);
  discard();
  throw FileError(path_ == "/dev/stdout" ? "standard output" : path_, what + ": " + reason);
}

}  // namespace detp::sim
