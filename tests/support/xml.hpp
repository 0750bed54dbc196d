#pragma once

#include <regex>
#include <string>
#include <vector>

/// Looks at pictures and pages as text.
namespace detp::support {

/// Whether every element is closed, in the right order, and no text has a bare < or &.
inline bool is_well_formed(const std::string& xml) {
  static const std::regex reference("&(amp|lt|gt|quot);");
  std::vector<std::string> open;
  std::string text;
  for (std::size_t at = 0; at < xml.size(); at += text.size()) {
    const std::size_t end = xml.find_first_of("<>", at + 1);
    const bool is_tag = xml[at] == '<' && end != std::string::npos && xml[end] == '>';
    text = xml.substr(at, is_tag ? end + 1 - at : end == std::string::npos ? end : end - at);
    if (text.find('&') != std::string::npos && std::regex_replace(text, reference, "").find('&') != std::string::npos)
      return false;
    if (!is_tag) {
      if (text[0] == '<' || text[0] == '>') return false;
    } else if (text.starts_with("</")) {
      if (open.empty() || "</" + open.back() + ">" != text) return false;
      open.pop_back();
    } else if (!text.starts_with("<?") && !text.ends_with("/>")) {
      open.push_back(text.substr(1, text.find_first_of(" >") - 1));
    }
  }
  return open.empty();
}

inline std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace detp::support
