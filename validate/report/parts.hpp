#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "detp/model/vocabulary/technique.hpp"
#include "detp/validate/picture/svg.hpp"

/// What the sections of a page read in the JSON answer of `detp report`.
namespace detp::validate {

using ReportJson = nlohmann::ordered_json;

/// The answer of the part with this name; null if the part was not made.
[[nodiscard]] const ReportJson& answer_of(const ReportJson& report, std::string_view part);

/// The number at the key; nothing if there is none, or null.
[[nodiscard]] std::optional<double> number(const ReportJson& json, std::string_view key);

/// The text at the key; empty if there is none, or null.
[[nodiscard]] std::string words(const ReportJson& json, std::string_view key);

/// The array or object at the key; an empty array if there is none.
[[nodiscard]] const ReportJson& list(const ReportJson& json, std::string_view key);

/// "fan-out 8, leaf 16" of a candidate's parameters.
[[nodiscard]] std::string parameter_words(const ReportJson& candidate);

/// The technique with this name; nothing for an unknown one.
[[nodiscard]] std::optional<Technique> technique_named(std::string_view name);

/// Colour and CSS class of a technique; grey for an unknown name.
[[nodiscard]] Paint paint_of(std::string_view technique);

/// "7.8 ms ± 1.6 ms".
[[nodiscard]] std::string seconds_words(double seconds, std::optional<double> error = {});

/// "1.02", "0.31": a ratio with three digits.
[[nodiscard]] std::string ratio_words(std::optional<double> ratio);

/// 85 967 as "85 967"; from 10⁷ on "3.1e7".
[[nodiscard]] std::string count_words(double count);

}  // namespace detp::validate
