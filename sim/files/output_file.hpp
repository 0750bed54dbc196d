#pragma once

#include <stop_token>
#include <string>
#include <string_view>

namespace detp::sim {

/// A file being written, which replaces the target only when it is complete.
///
/// Writes to another file in the same folder and moves it to the target on commit(). Until then an existing target
/// stays unchanged; a writer that fails, or is destroyed without commit(), leaves nothing behind. If the file system
/// supports it, the file has no name until commit(), so nothing is left even if the program is killed. Follows links
/// and keeps an existing file's permissions. Anything but a regular file (/dev/stdout, /dev/full, a pipe) is written
/// directly. Every failure throws FileError with the system's reason. (SIGPIPE and SIGXFSZ must be ignored for this to
/// work.)
///
/// Waits for the reader of a pipe; after a stop request 0.15 s, then it throws Stopped.
class OutputFile {
 public:
  enum class Temporary {
    unnamed,  ///< a nameless file, if the file system supports it; else `named`
    named     ///< a part file (part_files.hpp)
  };

  explicit OutputFile(const std::string& path, std::stop_token stop = {}, Temporary temporary = Temporary::unnamed);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends the text. Output is buffered, so an error such as a full disk may only appear later or in commit().
  void write(std::string_view text);

  /// Moves the file to its target. Nothing may be written after commit().
  void commit();

 private:
  void open_temporary(Temporary temporary);
  void open_pipe();
  void flush();
  void wait_for_reader();
  void name_unnamed();
  void discard();
  [[noreturn]] void fail(const std::string& what);

  std::string path_;    ///< as the caller spelled it, for messages
  std::string target_;  ///< path_ with links followed; empty if the target is written directly
  std::string part_;    ///< the file to be renamed to the target; empty for a nameless file
  std::string buffer_;
  std::stop_token stop_;
  int descriptor_ = -1;
  bool may_wait_ = false;  ///< a pipe or the like
};

}  // namespace detp::sim
