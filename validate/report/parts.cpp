#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "detp/validate/picture/number_labels.hpp"
#include "detp/validate/picture/technique_sign.hpp"

namespace detp::validate {
namespace {

const ReportJson nothing;
const ReportJson no_items = ReportJson::array();

const ReportJson& member(const ReportJson& json, std::string_view key) {
  if (!json.is_object()) return nothing;
  const auto found = json.find(std::string(key));
  return found == json.end() ? nothing : *found;
}

}  // namespace

const ReportJson& answer_of(const ReportJson& report, std::string_view part) {
  for (const ReportJson& one : list(report, "parts"))
    if (words(one, "name") == part) return member(one, "answer");
  return nothing;
}

std::optional<double> number(const ReportJson& json, std::string_view key) {
  const ReportJson& value = member(json, key);
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

std::string words(const ReportJson& json, std::string_view key) {
  const ReportJson& value = member(json, key);
  return value.is_string() ? value.get<std::string>() : "";
}

const ReportJson& list(const ReportJson& json, std::string_view key) {
  const ReportJson& value = member(json, key);
  return value.is_structured() ? value : no_items;
}

std::string parameter_words(const ReportJson& candidate) {
  std::string text;
  for (const auto& [key, value] : list(candidate, "parameters").items()) {
    std::string name = key;
    std::ranges::replace(name, '_', '-');
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name,
                        value.is_string()         ? value.get<std::string>()
                        : value.is_number_float() ? fmt::format("{:.3g}", value.get<double>())
                                                  : value.dump());
  }
  return text;
}

std::optional<Technique> technique_named(std::string_view name) {
  for (const TechniqueRecord& record : technique_records)
    if (detp::name(record.technique) == name) return record.technique;
  return std::nullopt;
}

Paint paint_of(std::string_view technique) {
  const auto known = technique_named(technique);
  return known ? Paint{colour_of(*known), name(*known)} : Paint{"#888888"};
}

std::string seconds_words(double seconds, std::optional<double> error) {
  if (!error || !(*error > 0)) return seconds_label(seconds);
  return fmt::format("{} ± {}", seconds_label(seconds), seconds_label(*error));
}

std::string ratio_words(std::optional<double> ratio) { return ratio ? fmt::format("{:.3g}", *ratio) : ""; }

std::string count_words(double count) {
  if (count >= 1e7) return rays_label(count);
  std::string digits = fmt::format("{:.0f}", count);
  for (std::size_t i = digits.size(); i > 3;) digits.insert(i -= 3, "\u202f");
  return digits;
}

}  // namespace detp::validate
