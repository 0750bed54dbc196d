#include "effects_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

/// When an effect is on: "< 2.9", "differs from 1 by more than 0.05".
std::string condition_text(const sim::Threshold& threshold) {
  return threshold.side == sim::Threshold::Side::apart
             ? fmt::format("differs from {:.4g} by more than {:.4g}", threshold.at, threshold.tolerance)
             : sim::condition(threshold);
}

}  // namespace

std::string effects_line(const std::vector<sim::EffectReport>& effects) {
  std::string on;
  std::string off;
  for (const sim::EffectReport& report : effects) {
    std::string& list = report.on ? on : off;
    std::string why;
    if (!report.decided_by_evidence)
      why = " (by hand)";
    else if (report.on && !report.effect->is_input)
      why = fmt::format(" ({:.3g}{} {})", report.value,
                        report.effect->threshold.side == sim::Threshold::Side::apart ? "," : "",
                        condition_text(report.effect->threshold));
    else if (report.is_close())
      why = " (close)";
    list += fmt::format("{}{}{}", list.empty() ? "" : ", ", report.effect->name, why);
  }
  return fmt::format("effects   on: {}; off: {}", on.empty() ? "none" : on, off.empty() ? "none" : off);
}

std::string short_effects_line(const std::vector<sim::EffectReport>& effects) {
  const auto by_hand = [](const sim::EffectReport& one) { return !one.decided_by_evidence; };
  const bool all_by_hand =
      std::ranges::all_of(effects, [&](const sim::EffectReport& one) { return by_hand(one) || one.effect->is_input; });
  std::string on;
  std::size_t off = 0;
  for (const sim::EffectReport& report : effects)
    if (report.on)
      on += fmt::format("{}{}{}", on.empty() ? "" : ", ", report.effect->name,
                        by_hand(report) && !all_by_hand ? " (by hand)" : "");
    else
      ++off;
  return fmt::format("effects   on{}: {}{}", all_by_hand ? ", by hand" : "", on.empty() ? "none" : on,
                     on.empty() || off == 0 ? "" : fmt::format("; {} off", off));
}

std::string effects_table(const sim::Observed& observed, const std::vector<double>& if_switched, const Screen& screen) {
  TextTable table({{.head = "effect", .align = Align::left},
                   {.head = "evidence", .align = Align::left, .spare = 2},
                   {.head = "value"},
                   {.head = "on if", .align = Align::left},
                   {.head = "", .align = Align::left},
                   {.head = "tests if switched", .spare = 1},
                   {.head = "", .align = Align::left}});
  for (std::size_t i = 0; i < observed.effects.size(); ++i) {
    const sim::EffectReport& report = observed.effects[i];
    const std::string error = report.standard_error > 0 ? fmt::format(" ± {:.1g}", report.standard_error) : "";
    table.add({{std::string(report.effect->name)},
               {std::string(report.effect->evidence)},
               {fmt::format("{:.3g}{}", report.value, error)},
               {condition_text(report.effect->threshold)},
               {report.on ? "on" : "off", report.on ? Style::good : Style::faint},
               {if_switched[i] > 0 ? fmt::format("{:.3g}x", if_switched[i]) : ""},
               {report.is_close() ? "close to its threshold" : ""}});
  }
  return table.text(screen);
}

}  // namespace detp::cli
