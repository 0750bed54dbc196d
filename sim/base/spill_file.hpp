#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace detp::sim {

/// Bytes that are written once, and read back in pieces: the last few in memory, the others in a temporary file without a name, in
/// the folder that TMPDIR names (/tmp). There is no file for up to `most_in_memory` bytes.
class SpillFile {
 public:
  static constexpr std::size_t most_in_memory = std::size_t{1} << 20;

  SpillFile() = default;
  ~SpillFile();
  SpillFile(SpillFile&& other) noexcept;
  SpillFile& operator=(SpillFile&&) = delete;

  [[nodiscard]] std::uint64_t size() const { return written_ + last_.size(); }
  /// Throws std::runtime_error with the system's reason if the file cannot be made or written.
  void append(std::span<const std::byte> bytes);
  /// Fills `bytes` with those from `offset` on, which must exist. May be called by several threads. Throws likewise.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  void write_last();

  int descriptor_ = -1;
  std::uint64_t written_ = 0;  ///< bytes in the file
  std::vector<std::byte> last_;
};

}  // namespace detp::sim
