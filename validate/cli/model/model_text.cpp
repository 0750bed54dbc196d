#include "model_answer.hpp"

#include <fmt/format.h>

#include <cmath>

#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/best_published_ratio.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"

namespace detp::cli {
namespace {

struct Part {
  const char* key;
  const char* meaning;
};
constexpr Part parts[]{{"rebuild_time", "T_R (making lists of rays)"},
                       {"traverse_time", "walking through cells"},
                       {"intersect_time", "T_I (testing rays with discs)"},
                       {"copy_time", "copying rays"},
                       {"order_time", "sorting discs"},
                       {"build_time", "building the index"}};

/// A time in the unit of the costs.
std::string amount(double time, bool with_costs) {
  return with_costs ? fmt::format("{:.4g} s", time) : fmt::format("{:.4g}", time);
}

std::string compared(double time, double with) {
  const double change = 100 * (time / with - 1);
  return std::abs(change) < 0.05 ? "the same T"
                                 : fmt::format("{:.3g} % {} T", std::abs(change), change < 0 ? "less" : "more");
}

std::string time_line(const Json& json, bool with_costs) {
  std::string text = "T         " + amount(json["total_time"], with_costs);
  std::string list;
  for (const Part& part : parts)
    if (const double time = json.value(part.key, 0.0); time > 0)
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", part.meaning, amount(time, with_costs));
  if (!list.empty()) text += " = " + list;
  return text + (with_costs ? "" : ". Every test and step costs 1 (--costs gives seconds)") + "\n";
}

/// The Q and k of least T by the question's form.
std::string best_ratio_line(const ModelQuestion& question, double time, bool with_costs) {
  double ratio = 0;
  double best = 0;
  std::int64_t spheres = 0;
  if (question.form == Form::published) {
    const auto found = model::published::best_ratio(question.workload, question.costs);
    ratio = found.ratio;
    spheres = found.spheres;
    best = found.time;
  } else {
    const auto found = model::best_ratio_and_stop(question.workload, question.costs);
    ratio = found.ratio;
    spheres = found.spheres;
    best = found.time + model::time_at_any_ratio(question.workload, question.costs);
  }
  if (spheres == 0) return "best      no sphere: every ray is tested with every disc\n";
  return fmt::format("best      Q = {:.3g} with k = {}: T = {}, {}\n", ratio, spheres, amount(best, with_costs),
                     compared(best, time));
}

std::string stop_line(const Json& json) {
  const std::int64_t spheres = json["k"];
  const std::int64_t most = json["k_max"];
  const std::int64_t best = json["k_best"];
  std::string text = spheres == most
                         ? fmt::format("k         {}, all spheres that can hold a disc", spheres)
                         : fmt::format("k         {} of the {} spheres that can hold a disc", spheres, most);
  text +=
      spheres == best ? "; this k is the fastest at this Q" : fmt::format("; at this Q k = {} is the fastest", best);
  return text + ". detp run takes the fastest, or --spheres\n";
}

/// What the other form predicts with the same parameters, k its own.
std::string other_form_line(const ModelQuestion& question, double time, bool with_costs) {
  ModelQuestion other = question;
  other.form = question.form == Form::published ? Form::corrected : Form::published;
  const Json json =
      question.technique == Technique::octree ? octree_answer(other).json : sphere_cache_answer(other).json;
  const double of_other = json["total_time"];
  std::string text = fmt::format("{:<9} T = {}", name(other.form), amount(of_other, with_costs));
  if (json.contains("k")) text += fmt::format(" with k = {}", json["k"].get<std::int64_t>());
  return text + fmt::format(", {:.2g} of the {} form\n", of_other / time, name(question.form));
}

std::string best_parameters_line(const ModelQuestion& question, const ModelAnswer& answer, double time,
                                 bool with_costs) {
  const auto best = model::complete(question.technique, {}, question.workload, question.costs);
  if (!best) return "";
  if (best->parameters == answer.parameters) return "best      these parameters, by this formula\n";
  const auto counts = model::predict(question.workload, *best, question.options.engine);
  const double least = price(counts, question.costs, question.technique).total();
  return fmt::format("best      {}: T = {}, {}\n", title(*best), amount(least, with_costs), compared(least, time));
}

}  // namespace

std::string counting_command(const ModelQuestion& question, const ModelAnswer& answer, const std::string& workload) {
  using enum Technique;
  if (answer.json.value("k_max", std::int64_t{1}) == 0) return "";
  if (const auto* cache = std::get_if<SphereCacheParameters>(&answer.parameters))
    return fmt::format("command   detp validate {} --experiments sphere-cache --ratio {}\n", workload, cache->ratio);
  if (question.technique == brute_force) return "";
  const bool index = question.technique == octree || question.technique == grid;
  return fmt::format("command   detp validate {} --experiments {}\n", workload, index ? "index" : "hierarchies");
}

std::string model_sentences(const ModelQuestion& question, const ModelAnswer& answer, bool with_costs) {
  const Workload& w = question.workload;
  const Json& json = answer.json;
  const double time = json["total_time"];
  const bool cache = std::holds_alternative<SphereCacheParameters>(answer.parameters);
  std::string text =
      fmt::format("technique {}, {} form\n", title({question.technique, answer.parameters}), name(question.form));
  text += fmt::format("workload  {:.6g} {}, {:.6g} samples, d = {:.4g}, r0 = {:.4g}, D = {:.2f}\n", w.rays,
                      w.path_length > 0 ? "rays that end" : "lines", w.samples, w.disc_radius, w.sphere_radius,
                      w.dimension);
  text += time_line(json, with_costs);
  if (cache && json["k_max"] == 0) {
    text += "k         0: no sphere holds a disc, so every ray is tested with every disc\n";
  } else if (cache) {
    text += best_ratio_line(question, time, with_costs) + stop_line(json);
  } else if (question.form == Form::corrected) {
    text += best_parameters_line(question, answer, time, with_costs);
  }
  const bool has_other_form = cache ? json["k_max"] != 0 : question.technique == Technique::octree;
  if (has_other_form) text += other_form_line(question, time, with_costs);
  const double hits = model::expected_hits(w);
  return text + fmt::format("hits      {:.4g} expected, {:.3g} a disc\n", hits, hits / w.samples);
}

}  // namespace detp::cli
