#include "extrapolated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace detp::cli {

Json extrapolated_json(const std::vector<std::string>& reasons) {
  return {{"extrapolated", !reasons.empty()}, {"extrapolated_because", reasons}};
}

std::string_view extrapolation_mark(Technique technique, const std::vector<std::string>& reasons, bool real) {
  if (reasons.empty()) return "";
  return real && technique != Technique::box_tree && technique != Technique::brute_force ? "!" : "~";
}

std::string extrapolated_note(std::span<const std::pair<Technique, std::vector<std::string>>> predictions, bool real) {
  std::set<Technique> marked;
  std::vector<std::pair<std::string, std::set<Technique>>> reasons;  // in order of appearance
  for (const auto& [technique, why] : predictions)
    for (const std::string& reason : why) {
      marked.insert(technique);
      auto known = std::find_if(reasons.begin(), reasons.end(), [&](const auto& one) { return one.first == reason; });
      if (known == reasons.end()) known = reasons.insert(known, {reason, {}});
      known->second.insert(technique);
    }
  const bool doubted = std::any_of(predictions.begin(), predictions.end(), [&](const auto& one) {
    return extrapolation_mark(one.first, one.second, real) == "!";
  });
  const bool compared = std::any_of(predictions.begin(), predictions.end(), [&](const auto& one) {
    return extrapolation_mark(one.first, one.second, real) == "~";
  });
  const std::string_view first = !doubted   ? "~ extrapolated: "
                                 : compared ? "~ extrapolated, ! also never chosen: "
                                            : "! extrapolated, never chosen: ";
  std::string note;
  for (const auto& [reason, techniques] : reasons) {
    std::vector<std::string_view> names;
    if (techniques.size() < marked.size())
      for (const Technique technique : techniques) names.push_back(name(technique));
    note += fmt::format("{}{}", note.empty() ? first : "; ", reason);
    if (!names.empty()) note += fmt::format(" ({})", fmt::join(names, ", "));
  }
  return note;
}

}  // namespace detp::cli
