#pragma once

#include <string>
#include <string_view>

namespace detp::sim {

/// A file being written, which takes its place only when it is complete.
///
/// Writes aside in the same folder, and takes its place on commit(): until then a file of that name stays as it was,
/// and a writer that fails or is destroyed without commit() leaves nothing behind. Until commit() the file has no name
/// where the file system can do that, so that nothing is left even where the program is killed. A link is followed; an
/// existing file's permissions are kept. What is no regular file (/dev/stdout, /dev/full, a pipe) is written directly.
/// Every failure throws FileError with the system's reason. (SIGPIPE and SIGXFSZ must be ignored for it to get that
/// far.)
class OutputFile {
 public:
  enum class Aside {
    unnamed,  ///< where the file system can do it, else named
    named     ///< a part file (part_files.hpp)
  };

  explicit OutputFile(const std::string& path, Aside aside = Aside::unnamed);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Adds the text; buffered, so a full disk may show only later or in commit().
  void write(std::string_view text);

  /// Puts the file in its place. Nothing may be written after it.
  void commit();

 private:
  void open_aside(Aside aside);
  void flush();
  void name_unnamed();
  void discard();
  [[noreturn]] void fail(const std::string& what);

  std::string path_;    ///< as given: for messages
  std::string target_;  ///< with links followed; empty where it is written directly
  std::string part_;    ///< what is renamed to the target; empty for a file without a name
  std::string buffer_;
  int descriptor_ = -1;
};

}  // namespace detp::sim
