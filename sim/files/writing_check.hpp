#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "detp/sim/base/stop_check.hpp"
#include "output_file.hpp"

/// What writers of files share.
namespace detp::sim {

/// Checks for a stop request while a file is written.
class WritingCheck {
 public:
  /// `things` is the number of things to write. `unit` is their name in the plural, a string of static storage.
  WritingCheck(const std::string& path, std::uint64_t things, const char* unit, const std::stop_token& stop)
      : path_(path), check_(stop), written_{0, things, unit} {}

  /// To be called before each thing is written. Throws Stopped if a stop was requested.
  void next() {
    constexpr std::uint64_t work = 8;  // a line of numbers takes nearly a microsecond
    if (check_.requested_after(work))
      throw Stopped("stopped while writing " + path_ + " after " + std::to_string(written_.done) + " of " +
                        std::to_string(written_.of) + " " + std::string(written_.unit),
                    written_);
    ++written_.done;
  }

 private:
  const std::string& path_;
  StopCheck check_;
  Progress written_;
};

/// Writes a number of a binary PLY file.
template <class Number>
void write_little_endian(OutputFile& file, Number number) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  file.write({bytes.data(), bytes.size()});
}

}  // namespace detp::sim
