#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace detp::sim {

/// Number of bytes whose reading is a unit of work (StopCheck).
inline constexpr std::uint64_t bytes_a_unit = 8;

/// Reads a file, a pipe or a device piece by piece; "-" is standard input. What was compressed by gzip is unpacked. While a pipe or device delivers nothing, a stop request ends the
/// wait within 0.1 s: Stopped is thrown.
class InputFile {
 public:
  /// Opens the file. Throws FileError with the system's reason if it is missing or unreadable.
  explicit InputFile(std::string path, std::stop_token stop = {});
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

  /// The bytes that have been read and not skipped. Valid until the next fetch.
  [[nodiscard]] std::string_view buffered() const { return {buffer_.data() + begin_, end_ - begin_}; }

  /// Reads until at least `bytes` bytes are in buffered(). Returns false if the file ends before. Throws FileError with
  /// the system's reason (for instance if the path is a folder), and Stopped.
  bool fetch(std::size_t bytes) { return end_ - begin_ >= bytes || fetch_more(bytes); }

  /// Skips bytes of buffered().
  void skip(std::size_t bytes) { begin_ += bytes; }

  /// Number of bytes that have not been skipped: those in buffered() and those not yet read. Nullopt for pipes, devices,
  /// compressed files and files that report size 0.
  [[nodiscard]] std::optional<std::uint64_t> rest() const;

 private:
  class Unpacker;

  void unpack_gzip();
  bool fetch_more(std::size_t bytes);
  /// Reads the next bytes into the buffer; false at the end of the file.
  bool read_once();
  /// Reads the next bytes as they are; 0 at the end of the file.
  std::size_t read_raw(char* to, std::size_t most);
  void wait_for_input() const;
  void check_stop() const;

  std::string path_;
  std::stop_token stop_;
  int descriptor_ = -1;
  bool regular_ = false;
  std::uint64_t size_ = 0;  ///< size of a regular file; 0: unknown
  std::uint64_t read_ = 0;  ///< bytes read so far
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::unique_ptr<Unpacker> unpacker_;  ///< of a compressed file
};

/// The path without an ending ".gz".
[[nodiscard]] std::string_view without_gz(std::string_view path);

/// The whole content of a file of at most `most` bytes. Throws FileError if it has more, and as InputFile does.
[[nodiscard]] std::string read_file(const std::string& path, std::size_t most, std::stop_token stop = {});

/// Whether the path has this ending, ignoring case. `ending` is in lower case, such as ".ply".
[[nodiscard]] bool has_ending(std::string_view path, std::string_view ending);

}  // namespace detp::sim
