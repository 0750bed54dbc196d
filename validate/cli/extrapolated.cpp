#include "extrapolated.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace detp::cli {

Json extrapolated_json(const std::vector<std::string>& reasons) {
  return {{"extrapolated", !reasons.empty()}, {"extrapolated_because", reasons}};
}

std::string extrapolated_lines(std::span<const std::pair<Technique, std::vector<std::string>>> predictions) {
  std::vector<std::pair<std::string, std::string>> techniques_of;  // by reason, as they come
  for (const auto& [technique, reasons] : predictions)
    for (const std::string& reason : reasons) {
      const auto known = std::find_if(techniques_of.begin(), techniques_of.end(),
                                      [&](const auto& entry) { return entry.first == reason; });
      if (known == techniques_of.end())
        techniques_of.emplace_back(reason, name(technique));
      else if (known->second.find(name(technique)) == std::string::npos)
        known->second += fmt::format(", {}", name(technique));
    }
  std::string text;
  for (const auto& [reason, techniques] : techniques_of)
    text += fmt::format("~ extrapolated: {} ({})\n", reason, techniques);
  return text;
}

}  // namespace detp::cli
