#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "command.hpp"
#include "detp/model/best_ratio.hpp"
#include "detp/model/box_tree_rule.hpp"
#include "detp/model/choose.hpp"
#include "detp/sim/scene/output_file.hpp"
#include "detp/validate/unit_costs.hpp"
#include "outputs.hpp"
#include "timed_run.hpp"
#include "workload_options.hpp"

namespace detp::cli {
namespace {

struct RunOptions {
  WorkloadOptions workload;
  CandidateOptions candidate;
  int repeat = 0;
  std::optional<std::string> per_disc;
  std::optional<std::string> pairs;
};

SphereCacheParameters complete_cache(const CandidateOptions& options, const Workload& workload) {
  const UnitCosts costs = validate::built_in_unit_costs();
  if (options.ratio) require_ratio("radius ratio Q", *options.ratio);
  if (options.spheres) require_count("number of spheres", static_cast<double>(*options.spheres), 1, 1e18);
  if (options.ratio && options.spheres) return {*options.ratio, *options.spheres, options.sample_order()};
  const model::BestRatio best = options.ratio     ? model::best_stop(workload, costs, {*options.ratio})
                                : options.spheres ? model::best_ratio_for(workload, costs, *options.spheres)
                                                  : model::best_ratio_and_stop(workload, costs);
  return {best.ratio, std::max<std::int64_t>(1, best.spheres), options.sample_order()};
}

/// Boxes, unless spheres are asked for: they are the faster (sim/README.md).
SphereTreeParameters complete_tree(const CandidateOptions& options, const Workload& workload) {
  if (options.bounds && bounds_named(*options.bounds) == Bounds::spheres)
    return model::best_sphere_tree(workload, validate::built_in_unit_costs(), options.fan_out, options.leaf);
  const SphereTreeParameters rule = model::box_tree_rule(workload);
  return {options.fan_out.value_or(rule.fan_out), options.leaf.value_or(rule.leaf), Bounds::boxes};
}

/// The depth that is best top-down serves for all traversals.
OctreeParameters complete_octree(const CandidateOptions& options, const Workload& workload) {
  const Traversal traversal = options.chosen_traversal();
  if (options.depth) return {*options.depth, traversal};
  const auto best = model::best_of(Technique::octree, workload, validate::built_in_unit_costs());
  if (!best) throw std::length_error("octree would not fit in memory on this workload");
  return {std::get<OctreeParameters>(best->candidate.parameters).depth, traversal};
}

/// There is no closed form to say which are best.
BspParameters complete_bsp(const CandidateOptions& options) {
  const BspParameters otherwise;
  return {options.depth.value_or(otherwise.depth), options.leaf.value_or(otherwise.leaf)};
}

/// The technique asked for, or the one that the closed forms choose; parameters left out are the best by the same
/// forms.
Candidate complete(const CandidateOptions& options, const Workload& workload) {
  const UnitCosts costs = validate::built_in_unit_costs();
  if (!options.technique) {
    const Candidate chosen = model::rank(workload, costs).front().candidate;
    options.refuse_foreign(chosen.technique);
    return chosen;
  }
  const Technique technique = options.technique_or(Technique::brute_force);
  options.refuse_foreign(technique);
  if (technique == Technique::sphere_cache || technique == Technique::sphere_cache_published)
    return {technique, complete_cache(options, workload)};
  if (technique == Technique::cell_spheres && options.depth) return {technique, CellSpheresParameters{*options.depth}};
  if (technique == Technique::sphere_tree) return {technique, complete_tree(options, workload)};
  if (technique == Technique::octree) return {technique, complete_octree(options, workload)};
  if (technique == Technique::bsp) return {technique, complete_bsp(options)};
  if (technique == Technique::grid && options.cells) return {technique, GridParameters{*options.cells}};
  if (technique == Technique::bvh) return {technique, options.bvh()};
  if (technique == Technique::photon_map) return {technique, options.photon_map()};
  const auto best = model::best_of(technique, workload, costs);
  if (!best) throw std::length_error(fmt::format("{} would not fit in memory on this workload", name(technique)));
  return best->candidate;
}

std::string per_disc_csv(const sim::Outcome& outcome) {
  std::string csv = "disc,hits,irradiance\n";
  for (std::size_t disc = 0; disc < outcome.hits.size(); ++disc)
    csv += fmt::format("{},{},{}\n", disc, outcome.hits[disc], outcome.irradiance[disc]);
  return csv;
}

void write_pairs(const std::string& path, const std::vector<sim::Pair>& pairs) {
  sim::OutputFile file(path);
  file.write("ray,disc\n");
  for (const sim::Pair& pair : pairs) file.write(fmt::format("{},{}\n", pair.ray, pair.disc));
  file.commit();
}

void write_text(const std::string& path, const std::string& text) {
  sim::OutputFile file(path);
  file.write(text);
  file.commit();
}

Json seconds_json(const Timing& timing, int repeat) {
  Json json{{"total", timing.total()},
            {"prepare", timing.prepare},
            {"order", timing.phases.order},
            {"build", timing.phases.build},
            {"search", timing.phases.search}};
  if (repeat > 0) json["all"] = timing.all;
  return json;
}

double mean_irradiance(const sim::Outcome& outcome) {
  double sum = 0;
  for (const double irradiance : outcome.irradiance) sum += irradiance;
  return sum / static_cast<double>(outcome.irradiance.size());
}

std::string to_text(const validate::Job& job, const Candidate& candidate, const TimedRun& run, const Timing& timing) {
  const sim::Outcome& outcome = run.outcome;
  std::string text = describe(job);
  text += fmt::format("technique {} {}\n", name(candidate.technique), describe(candidate.parameters));
  text += fmt::format("hits      {}, {:.4g} a disc; mean irradiance {:.6g}\n", outcome.total_hits,
                      static_cast<double>(outcome.total_hits) / static_cast<double>(outcome.hits.size()),
                      mean_irradiance(outcome));
  text += fmt::format(
      "seconds   {:.4g}: prepare {:.3g}, order {:.3g}, build {:.3g}, search {:.3g}; reading {:.3g} before\n",
      timing.total(), timing.prepare, timing.phases.order, timing.phases.build, timing.phases.search,
      job.read_seconds + run.read_seconds);
  text += "counts    ";
  std::string counts;
  for_each_term(outcome.counts, [&](std::string_view term, std::uint64_t value) {
    if (value > 0) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", term, value);
  });
  text += counts + "\n";
  if (outcome.stopped) text += "stopped   before the end: what is above is partial\n";
  return text;
}

Result run_run(const RunOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  require_count("--repeat", options.repeat, 0, 10000);
  check_outputs({{"--output", common.output}, {"--per-disc", options.per_disc}, {"--pairs", options.pairs}});
  const ProgressLine progress(common);
  progress.show("scene and rays", 0);
  validate::JobRequest request = options.workload.request(common);
  request.stream =
      options.candidate.technique_or(Technique::brute_force) != Technique::photon_map;  // wants all at once
  const validate::Job job = validate::make_job(request, stop);
  for (const std::string& notice : job.notices) note(common, notice);
  const Candidate candidate = complete(options.candidate, job.workload);
  const TimedRun run =
      run_job(job, candidate, {.pairs = options.pairs.has_value(), .stop = stop, .threads = common.threads}, progress);
  const sim::Outcome& outcome = run.outcome;
  const Timing timing = time_runs(job, candidate, run, outcome.stopped ? 0 : options.repeat,
                                  {.count = false, .stop = stop, .threads = common.threads}, progress);
  if (outcome.stopped && (options.per_disc || options.pairs))
    note(common, "stopped before the end: --per-disc and --pairs are not written, for they would be partial");
  if (options.per_disc && !outcome.stopped) write_text(*options.per_disc, per_disc_csv(outcome));
  if (options.pairs && !outcome.stopped) write_pairs(*options.pairs, outcome.pairs);

  Result result;
  result.code = outcome.stopped ? ExitCode::stopped : ExitCode::done;
  result.inputs = to_json(job, request);
  result.inputs["repeat"] = options.repeat;
  result.json = {{"technique", name(candidate.technique)},
                 {"parameters", to_json(candidate.parameters)},
                 {"hits", outcome.total_hits},
                 {"mean_irradiance", mean_irradiance(outcome)},
                 {"counts", to_json(outcome.counts)},
                 {"seconds", seconds_json(timing, options.repeat)},
                 {"read_seconds", job.read_seconds + run.read_seconds},
                 {"rays_in_memory", run.rays_in_memory},
                 {"stopped", outcome.stopped}};
  result.text = to_text(job, candidate, run, timing);
  result.csv = per_disc_csv(outcome);
  return result;
}

}  // namespace

Command run_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("run", "The hits and the irradiance, by one technique");
  app->footer("Example: detp run @tree --rays 100000 --technique octree --per-disc irradiance.csv");
  const auto options = std::make_shared<RunOptions>();
  options->workload.add_to(*app);
  options->candidate.add_to(*app);
  app->add_option("--repeat", options->repeat, "time that many further runs, which do not count; the median is shown");
  app->add_option("--per-disc", options->per_disc, "write disc,hits,irradiance as CSV, in input order");
  app->add_option("--pairs", options->pairs, "write the hits as CSV ray,disc");
  return {app, [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_run(*options, common, stop);
          }};
}

}  // namespace detp::cli
