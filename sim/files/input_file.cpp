#include "input_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "detp/sim/base/stop_check.hpp"
#include "file_error.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t piece_size = 1 << 16;
constexpr int wait_milliseconds = 50;  // time between two checks for a stop request

}  // namespace

InputFile::InputFile(std::string path, std::stop_token stop) : path_(std::move(path)), stop_(std::move(stop)) {
  // Without O_NONBLOCK, opening a pipe that has no writer would block.
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) throw FileError(path_, std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status {};
  regular_ = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  if (regular_) size_ = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
  buffer_.resize(2 * piece_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

std::optional<std::uint64_t> InputFile::rest() const {
  if (size_ == 0) return std::nullopt;  // files of /proc report 0, too
  return buffered().size() + (size_ > read_ ? size_ - read_ : 0);
}

bool InputFile::fetch_more(std::size_t bytes) {
  if (begin_ > 0) std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (buffer_.size() < bytes + piece_size) buffer_.resize(std::max(bytes + piece_size, 2 * buffer_.size()));
  while (end_ < bytes)
    if (!read_once()) return false;
  return true;
}

bool InputFile::read_once() {
  for (;;) {
    check_stop();
    if (!regular_) wait_for_input();
    const ssize_t count = ::read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
    if (count >= 0) {
      end_ += static_cast<std::size_t>(count);
      read_ += static_cast<std::uint64_t>(count);
      StopCheck().add(static_cast<std::uint64_t>(count) / bytes_a_unit);
      return count > 0;
    }
    if (errno != EINTR && errno != EAGAIN)
      throw FileError(path_, std::string("cannot be read: ") + std::strerror(errno));
  }
}

void InputFile::wait_for_input() const {
  pollfd wanted{.fd = descriptor_, .events = POLLIN, .revents = 0};
  while (::poll(&wanted, 1, wait_milliseconds) <= 0) check_stop();
}

void InputFile::check_stop() const {
  if (stop_.stop_requested())
    throw Stopped("stopped while reading " + shown_path(path_) + " after " + std::to_string(read_) + " bytes");
}

std::string read_file(const std::string& path, std::size_t most, std::stop_token stop) {
  InputFile file(path, std::move(stop));
  std::string content;
  while (file.fetch(1)) {
    if (content.size() + file.buffered().size() > most)
      throw FileError(path, "is larger than " + std::to_string(most) + " bytes");
    content += file.buffered();
    file.skip(file.buffered().size());
  }
  return content;
}

bool has_ending(std::string_view path, std::string_view ending) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; };
  return path.size() >= ending.size() &&
         std::equal(ending.begin(), ending.end(), path.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [&same](char wanted, char given) { return same(given, wanted); });
}

}  // namespace detp::sim
