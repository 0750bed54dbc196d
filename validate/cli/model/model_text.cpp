#include "model_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "detp/model/lines/line_measure.hpp"
#include "detp/validate/cli/text/result.hpp"

namespace detp::cli {
namespace {

using validate::ModelAnswer;
using validate::ModelRequest;

/// A time in the unit of the costs.
std::string amount(double time, bool with_costs) {
  return with_costs ? fmt::format("{:.4g} s", time) : fmt::format("{:.4g}", time);
}

std::string compared(double time, double with) {
  const double change = 100 * (time / with - 1);
  return std::abs(change) < 0.05 ? "the same T"
                                 : fmt::format("{:.3g} % {} T", std::abs(change), change < 0 ? "less" : "more");
}

std::string time_line(const validate::ModelTimes& times, bool with_costs) {
  std::string text = "T         " + amount(times.total, with_costs);
  std::string list;
  for (const auto& [part, meaning] : {std::pair{times.rebuild, "T_R (making lists of rays)"},
                                      {times.traverse, "walking through cells"},
                                      {times.intersect, "T_I (testing rays with discs)"},
                                      {times.copy, "copying rays"},
                                      {times.order, "sorting discs"},
                                      {times.build, "building the index"}})
    if (part.value_or(0) > 0)
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", meaning, amount(*part, with_costs));
  if (!list.empty()) text += " = " + list;
  return text + (with_costs ? "" : ". Every test and step costs 1 (--costs gives seconds)") + "\n";
}

/// The parameters of least T by the question's form.
std::string best_line(const ModelAnswer& answer, const validate::ModelComparison& than, bool with_costs) {
  if (!than.best) return "";
  const std::string t =
      fmt::format("T = {}, {}\n", amount(than.best_time, with_costs), compared(than.best_time, answer.times.total));
  if (!answer.stops)
    return than.best->parameters == answer.candidate.parameters ? "best      these parameters, by this formula\n"
                                                                : fmt::format("best      {}: {}", title(*than.best), t);
  const auto* cache = std::get_if<SphereCacheParameters>(&than.best->parameters);
  return cache == nullptr ? "best      no sphere: every ray is tested with every disc\n"
                          : fmt::format("best      Q = {:.3g} with k = {}: {}", cache->ratio, cache->spheres, t);
}

std::string stop_line(const validate::CacheStops& stops) {
  const auto& [k, most, best, published, corrected] = stops;
  if (most == 0) return "k         0: no sphere holds a disc, so every ray is tested with every disc\n";
  return fmt::format(
      "k         {}; {}. detp run takes the fastest, or --spheres\n",
      k == most ? fmt::format("{}, all spheres that can hold a disc", k)
                : fmt::format("{} of the {} spheres that can hold a disc", k, most),
      k == best ? "this k is the fastest at this Q" : fmt::format("at this Q k = {} is the fastest", best));
}

std::string other_form_line(const ModelAnswer& answer, const ModelAnswer& other, bool with_costs) {
  std::string text = fmt::format("{:<9} T = {}", name(other.form), amount(other.times.total, with_costs));
  if (other.stops) text += fmt::format(" with k = {}", other.stops->spheres);
  return text + fmt::format(", {:.2g} of the {} form\n", other.times.total / answer.times.total, name(answer.form));
}

std::string sentences(const ModelRequest& request, const ModelAnswer& answer, bool with_costs) {
  const Workload& w = request.workload;
  std::string text = fmt::format("technique {}, {} form\n", title(answer.candidate), name(answer.form));
  text += fmt::format("workload  {:.6g} {}, {:.6g} samples, d = {:.4g}, r0 = {:.4g}, D = {:.2f}\n", w.rays,
                      w.path_length > 0 ? "rays that end" : "lines", w.samples, w.disc_radius, w.sphere_radius,
                      w.dimension);
  text += time_line(answer.times, with_costs);
  const validate::ModelComparison than = compare(request, answer);
  text += best_line(answer, than, with_costs);
  if (answer.stops) text += stop_line(*answer.stops);
  if (than.other_form) text += other_form_line(answer, *than.other_form, with_costs);
  const double hits = model::expected_hits(w);
  text += fmt::format("hits      {:.4g} expected, {:.3g} a disc", hits, hits / w.samples);
  if (answer.extrapolated_because.empty()) return text;
  return text + fmt::format("\ncaution   outside of what was compared with counts: {}",
                            fmt::join(answer.extrapolated_because, "; "));
}

/// The command, to be pasted, that counts what the formulas predict; empty if there is none.
std::string counting_command(const ModelAnswer& answer, const std::string& workload) {
  using enum Technique;
  const Technique technique = answer.candidate.technique;
  if (workload.empty() || technique == brute_force || (answer.stops && answer.stops->most == 0)) return "";
  const std::string experiments =
      answer.stops
          ? fmt::format("sphere-cache --ratio {}", std::get<SphereCacheParameters>(answer.candidate.parameters).ratio)
      : technique == octree || technique == grid ? "index"
                                                 : "hierarchies";
  return fmt::format("command   detp validate {} --experiments {}\n", workload, experiments);
}

std::string scalars(const Json& json, const std::string& prefix = "") {
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (value.is_array() || value.is_boolean()) continue;
    if (value.is_object())
      text += scalars(value, key + ".");
    else if (value.is_number())
      text += fmt::format("{:<26} {:.8g}\n", prefix + key, value.get<double>());
    else
      text += fmt::format("{:<26} {}\n", prefix + key, value.get<std::string>());
  }
  return text;
}

std::string level_table(const Json& levels) {
  if (levels.empty()) return {};
  std::string text;
  for (const auto& [key, value] : levels[0].items()) text += fmt::format("{}{:>13}", text.empty() ? "\n" : " ", key);
  for (const Json& level : levels) {
    std::string line;
    for (const auto& [key, value] : level.items())
      line += fmt::format("{}{:>13.6g}", line.empty() ? "\n" : " ", value.get<double>());
    text += line;
  }
  return text + "\n";
}

}  // namespace

std::string text_of(const ModelRequest& request, const ModelAnswer& answer, const ModelText& options,
                    const Screen& screen) {
  std::string text = wrapped(sentences(request, answer, options.with_costs), screen.text_width(), 10) +
                     counting_command(answer, options.workload);
  if (!options.verbose) {
    if (!request.curvature && !request.target_error) return text;
    const Json errors = cells_of(validate::error_fields(), answer.outlook);
    for (const auto& [name, value] : errors.items()) text += fmt::format("{:<26} {:.8g}\n", name, value.get<double>());
    return text;
  }
  const Json json = json_of(answer);
  return text + "\n" + scalars({{"technique", name(answer.candidate.technique)}}) + scalars(json) +
         level_table(json.value("spheres", Json::array()));
}

}  // namespace detp::cli
