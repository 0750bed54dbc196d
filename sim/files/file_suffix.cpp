#include "file_suffix.hpp"

#include <algorithm>

namespace detp::sim {
namespace {

constexpr std::size_t longest = 5;

bool is_digit(char one) { return one >= '0' && one <= '9'; }

/// In lower case; 0 if it is no letter and no digit.
char in_lower_case(char one) {
  if (one >= 'A' && one <= 'Z') return static_cast<char>(one - 'A' + 'a');
  return (one >= 'a' && one <= 'z') || is_digit(one) ? one : '\0';
}

}  // namespace

std::string suffix_of(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1);
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos || dot == 0) return "";
  std::string suffix(name.substr(dot + 1));
  if (suffix.empty() || suffix.size() > longest || std::ranges::all_of(suffix, is_digit)) return "";
  std::ranges::transform(suffix, suffix.begin(), in_lower_case);
  return suffix.find('\0') == std::string::npos ? "." + suffix : "";
}

}  // namespace detp::sim
