#pragma once

#include <regex>
#include <string>
#include <vector>

/// Looks at pictures and pages as text.
namespace detp::support {

/// Whether every element is closed, in the right order, and no text has a bare < or &.
inline bool is_well_formed(const std::string& xml) {
  static const std::regex token("<[^<>]*>|[^<>]+|.");
  static const std::regex reference("&(amp|lt|gt|quot);");
  std::vector<std::string> open;
  for (std::sregex_iterator one(xml.begin(), xml.end(), token); one != std::sregex_iterator(); ++one) {
    const std::string text = one->str();
    if (std::regex_replace(text, reference, "").find('&') != std::string::npos) return false;
    if (text[0] != '<') {
      if (text[0] == '>') return false;
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
