#include "whole_report.hpp"

#include <fmt/format.h>

#include <cmath>

namespace detp::cli {
namespace {

std::string megabytes(const std::optional<double>& bytes) {
  return bytes ? fmt::format("{:.0f} MB", 1e-6 * *bytes) : "memory not known";
}

/// In milliseconds, two digits: what is less does not matter beside the start of a program.
double rounded(double seconds) { return seconds < 0.01 ? std::round(1e3 * seconds) / 1e3 : seconds; }

}  // namespace

Json whole_json(const validate::WholeSeconds& seconds) {
  return {{"read", seconds.read},
          {"trace", seconds.trace},
          {"prepare", seconds.prepare},
          {"search", seconds.search},
          {"total", seconds.total()}};
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
