#include "input_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "file_error.hpp"

namespace detp::sim {

std::string read_file(const std::string& path) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
  if (!file) throw FileError(path, std::string("cannot be opened: ") + std::strerror(errno));
  std::string content;
  std::array<char, 65536> piece;
  while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), file.get()))
    content.append(piece.data(), count);
  if (std::ferror(file.get()) != 0) throw FileError(path, std::string("cannot be read: ") + std::strerror(errno));
  return content;
}

bool has_ending(std::string_view path, std::string_view ending) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; };
  return path.size() >= ending.size() &&
         std::equal(ending.begin(), ending.end(), path.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [&same](char wanted, char given) { return same(given, wanted); });
}

}  // namespace detp::sim
