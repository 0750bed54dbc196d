#include "prediction_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace detp::cli {
namespace {

std::string megabytes(const std::optional<double>& bytes) {
  return bytes ? fmt::format("{:.0f} MB", 1e-6 * *bytes) : "memory not known";
}

/// In milliseconds, two digits: what is less does not matter beside the start of a program.
double rounded(double seconds) { return seconds < 0.01 ? std::round(1e3 * seconds) / 1e3 : seconds; }

}  // namespace

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

std::string whole_line(const std::optional<Whole>& predicted, const std::optional<Whole>& measured) {
  using Parts = validate::WholeSeconds;
  const Whole& shown = measured ? *measured : predicted.value();
  const bool both = predicted && measured;
  std::string parts;
  const auto add = [&](const char* name, const auto& seconds_of) {
    const double seconds = rounded(seconds_of(shown.seconds));
    if (seconds == 0) return;
    parts += fmt::format("{}{} {:.2g}", parts.empty() ? "" : ", ", name, seconds);
    if (both) parts += fmt::format(" ({:.2g})", rounded(seconds_of(predicted->seconds)));
  };
  add("reading", [](const Parts& of) { return of.read; });
  add("tracing", [](const Parts& of) { return of.trace; });
  add("searching", [](const Parts& of) { return of.prepare + of.search; });
  return fmt::format("whole     {}{:.2g} s{}: {}; {}{}", measured ? "" : "predicted ", shown.seconds.total(),
                     both ? fmt::format(" (predicted {:.2g})", predicted->seconds.total()) : "", parts,
                     megabytes(shown.peak_bytes),
                     both && predicted->peak_bytes ? fmt::format(" ({:.0f})", 1e-6 * *predicted->peak_bytes) : "");
}

}  // namespace detp::cli
