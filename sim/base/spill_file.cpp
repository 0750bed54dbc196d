#include "spill_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace detp::sim {
namespace {

std::string folder() {
  const char* named = std::getenv("TMPDIR");
  return named != nullptr && *named != '\0' ? named : "/tmp";
}

[[noreturn]] void fail(const std::string& what) {
  const std::string reason = std::strerror(errno);
  throw std::runtime_error("a temporary file in " + folder() + " " + what + ": " + reason +
                           " (TMPDIR names another folder)");
}

int open_without_name() {
  const std::string in = folder();
  const int unnamed = ::open(in.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
  if (unnamed >= 0) return unnamed;
  std::string path = in + "/detp-XXXXXX";  // file systems without O_TMPFILE
  const int named = ::mkostemp(path.data(), O_CLOEXEC);
  if (named < 0) fail("cannot be made");
  ::unlink(path.c_str());
  return named;
}

}  // namespace

SpillFile::~SpillFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

SpillFile::SpillFile(SpillFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      written_(std::exchange(other.written_, 0)),
      last_(std::move(other.last_)) {}

void SpillFile::append(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    if (last_.size() == most_in_memory) write_last();
    const std::size_t count = std::min(bytes.size(), most_in_memory - last_.size());
    last_.insert(last_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    bytes = bytes.subspan(count);
  }
}

void SpillFile::write_last() {
  if (descriptor_ < 0) descriptor_ = open_without_name();
  for (std::size_t done = 0; done < last_.size();) {
    const ssize_t got = ::write(descriptor_, last_.data() + done, last_.size() - done);
    if (got < 0 && errno != EINTR) fail("cannot be written");
    if (got > 0) done += static_cast<std::size_t>(got);
  }
  written_ += last_.size();
  last_.clear();
}

void SpillFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty() && offset < written_) {
    const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), written_ - offset));
    const ssize_t got = ::pread(descriptor_, bytes.data(), most, static_cast<off_t>(offset));
    if (got == 0) errno = EIO;
    if (got == 0 || (got < 0 && errno != EINTR)) fail("cannot be read");
    if (got < 0) continue;
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  if (bytes.empty()) return;
  const std::size_t in_last = static_cast<std::size_t>(offset - written_);
  if (in_last + bytes.size() > last_.size()) throw std::logic_error("bytes that were not written are read");
  std::copy_n(last_.begin() + static_cast<std::ptrdiff_t>(in_last), bytes.size(), bytes.begin());
}

}  // namespace detp::sim
