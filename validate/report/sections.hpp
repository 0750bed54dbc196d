#pragma once

#include <string>

#include "parts.hpp"

/// The sections of a page, from the JSON answer of `detp report`. A section says so where its part was not made.
namespace detp::validate {

/// Technique, parameters, seconds, and what the accuracy costs: the top of the page.
[[nodiscard]] std::string answer_section(const ReportJson& report);

/// Seconds of each technique, predicted and measured.
[[nodiscard]] std::string choice_section(const ReportJson& report);

/// The fastest technique for other numbers of rays and other radii.
[[nodiscard]] std::string map_section(const ReportJson& report);

/// Error against time of each estimator.
[[nodiscard]] std::string accuracy_section(const ReportJson& report);

/// Predicted over counted tests, and over measured seconds.
[[nodiscard]] std::string comparison_section(const ReportJson& report);

/// Verdicts on the closed forms.
[[nodiscard]] std::string verdict_section(const ReportJson& report);

/// Evidence of each effect, and its threshold.
[[nodiscard]] std::string effects_section(const ReportJson& report);

/// Machine, version, seed; each part's command and seconds.
[[nodiscard]] std::string origin_section(const ReportJson& report);

}  // namespace detp::validate
