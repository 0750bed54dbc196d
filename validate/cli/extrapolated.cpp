#include "extrapolated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace detp::cli {

Json extrapolated_json(const std::vector<std::string>& reasons) {
  return {{"extrapolated", !reasons.empty()}, {"extrapolated_because", reasons}};
}

std::string extrapolated_note(std::span<const std::pair<Technique, std::vector<std::string>>> predictions) {
  std::set<Technique> marked;
  std::vector<std::pair<std::string, std::set<Technique>>> reasons;  // in order of appearance
  for (const auto& [technique, why] : predictions)
    for (const std::string& reason : why) {
      marked.insert(technique);
      auto known = std::find_if(reasons.begin(), reasons.end(), [&](const auto& one) { return one.first == reason; });
      if (known == reasons.end()) known = reasons.insert(known, {reason, {}});
      known->second.insert(technique);
    }
  std::string note;
  for (const auto& [reason, techniques] : reasons) {
    std::vector<std::string_view> names;
    if (techniques.size() < marked.size())
      for (const Technique technique : techniques) names.push_back(name(technique));
    note += fmt::format("{}{}", note.empty() ? "~ extrapolated: " : "; ", reason);
    if (!names.empty()) note += fmt::format(" ({})", fmt::join(names, ", "));
  }
  return note;
}

}  // namespace detp::cli
