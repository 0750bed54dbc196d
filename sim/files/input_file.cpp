#include "input_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include "detp/sim/base/stop_check.hpp"
#include "file_error.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t piece_size = 1 << 16;
constexpr int wait_milliseconds = 50;  // time between two checks for a stop request

}  // namespace

/// What gzip has compressed: one member behind the other.
class InputFile::Unpacker {
 public:
  Unpacker() : packed_(piece_size) {
    constexpr int gzip_alone = 16 + MAX_WBITS;
    if (inflateInit2(&state_, gzip_alone) != Z_OK) throw std::bad_alloc();
  }
  ~Unpacker() { inflateEnd(&state_); }
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  /// Compressed bytes that were read before.
  void give(std::string_view front) {
    packed_.assign(front.begin(), front.end());
    state_.next_in = reinterpret_cast<Bytef*>(packed_.data());
    state_.avail_in = static_cast<uInt>(packed_.size());
    packed_.resize(std::max(packed_.size(), piece_size));
  }

  /// Writes at most so many unpacked bytes; 0 at the end.
  template <class Read>
  std::size_t unpack(char* to, std::size_t most, const std::string& path, const Read& read) {
    state_.next_out = reinterpret_cast<Bytef*>(to);
    state_.avail_out = static_cast<uInt>(std::min<std::size_t>(most, 1 << 30));
    const uInt room = state_.avail_out;
    while (state_.avail_out == room) {
      if (state_.avail_in == 0) {
        state_.next_in = reinterpret_cast<Bytef*>(packed_.data());
        state_.avail_in = static_cast<uInt>(read(packed_.data(), packed_.size()));
        if (state_.avail_in == 0 && between_members_) return 0;
        if (state_.avail_in == 0) throw FileError(path, "ends in the middle of its compressed data");
      }
      if (between_members_) inflateReset(&state_);
      between_members_ = false;
      const int result = inflate(&state_, Z_NO_FLUSH);
      if (result == Z_STREAM_END)
        between_members_ = true;
      else if (result != Z_OK && result != Z_BUF_ERROR)
        throw FileError(path, "has damaged compressed data");
    }
    return room - state_.avail_out;
  }

 private:
  z_stream state_{};
  std::vector<char> packed_;
  bool between_members_ = false;
};

InputFile::InputFile(std::string path, std::stop_token stop) : path_(std::move(path)), stop_(std::move(stop)) {
  // Without O_NONBLOCK, opening a pipe that has no writer would block.
  descriptor_ = ::open(path_ == "-" ? "/dev/stdin" : path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) throw FileError(path_, std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status {};
  regular_ = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  if (regular_) size_ = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
  buffer_.resize(2 * piece_size);
  if (path_ != "-" && without_gz(path_).size() == path_.size()) return;
  try {
    unpack_gzip();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

/// From the front on, if it is compressed.
void InputFile::unpack_gzip() {
  constexpr std::string_view magic = "\x1f\x8b";
  if (!fetch(magic.size()) || !buffered().starts_with(magic)) return;
  unpacker_ = std::make_unique<Unpacker>();
  unpacker_->give(buffered());
  begin_ = end_ = 0;
  size_ = 0;
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
  char* const to = buffer_.data() + end_;
  const std::size_t room = buffer_.size() - end_;
  const std::size_t count =
      unpacker_
          ? unpacker_->unpack(to, room, path_, [this](char* raw, std::size_t most) { return read_raw(raw, most); })
          : read_raw(to, room);
  end_ += count;
  return count > 0;
}

std::size_t InputFile::read_raw(char* to, std::size_t most) {
  for (;;) {
    check_stop();
    if (!regular_) wait_for_input();
    const ssize_t count = ::read(descriptor_, to, most);
    if (count >= 0) {
      read_ += static_cast<std::uint64_t>(count);
      StopCheck().add(static_cast<std::uint64_t>(count) / bytes_a_unit);
      return static_cast<std::size_t>(count);
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

std::string_view without_gz(std::string_view path) {
  constexpr std::string_view gz = ".gz";
  return has_ending(path, gz) ? path.substr(0, path.size() - gz.size()) : path;
}

bool has_ending(std::string_view path, std::string_view ending) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; };
  return path.size() >= ending.size() &&
         std::equal(ending.begin(), ending.end(), path.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [&same](char wanted, char given) { return same(given, wanted); });
}

}  // namespace detp::sim
