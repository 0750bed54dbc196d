#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>

#include "accuracy_report.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/light_notes.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/cli/options/value_lists.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/words.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/stopping/execute_until.hpp"

namespace detp::cli {
namespace {

struct AccuracyOptions {
  std::string scene;
  std::optional<std::string> noise;
  std::optional<std::string> error;
  std::optional<double> seconds;
  std::optional<double> rays;
  std::optional<double> samples;
  std::vector<std::string> estimators;
  std::optional<std::string> lights;
  std::optional<std::string> crease;
  std::optional<std::string> up;
  std::optional<std::string> discs;
  std::optional<std::string> disc_radius;
  sim::FaceNames faces;
  std::optional<std::string> reference;
  std::optional<std::string> seeds;
  std::vector<std::string> axes;
  std::string effort = "default";
  bool check = false;
  bool front_facing = false;
  std::optional<std::string> checkpoint;
  bool resume = false;
};

constexpr double longest_check = 60;  // seconds; a longer answer is not run

constexpr std::uint64_t seeds_apart = 1000;  // of pilots and of the check

bool too_large(const validate::AccuracyPoint& point) {
  constexpr double bytes_of_a_ray = 3 * (sizeof(sim::Ray) + 20);
  return point.rays * bytes_of_a_ray > sim::memory_budget();
}

validate::AccuracyTarget target_of(const AccuracyOptions& options) {
  const int given = (options.noise ? 1 : 0) + (options.error ? 1 : 0) + (options.seconds ? 1 : 0);
  if (given > 1) throw std::invalid_argument("give one of --target-noise, --target-error and --time-budget");
  using Kind = validate::AccuracyTarget::Kind;
  if (options.error) return {Kind::total, parse_share("--target-error", *options.error)};
  if (options.seconds) return {Kind::seconds, *options.seconds};
  return {Kind::noise, options.noise ? parse_share("--target-noise", *options.noise) : 0.05};
}

std::vector<sim::Estimator> estimators_of(const AccuracyOptions& options) {
  std::vector<sim::Estimator> chosen;
  for (const std::string& text : options.estimators) {
    const auto found = std::ranges::find(sim::estimators, std::string_view(text), &sim::EstimatorRecord::name);
    if (found == sim::estimators.end()) {
      std::vector<std::string_view> names;
      for (const sim::EstimatorRecord& one : sim::estimators) names.push_back(one.name);
      throw std::invalid_argument(
          fmt::format("there is no estimator {}; there are {}", detp::quoted(text), fmt::join(names, ", ")));
    }
    chosen.push_back(found->estimator);
  }
  return chosen;
}

sim::Scene scene_of(const AccuracyOptions& options, std::uint64_t seed, const std::stop_token& stop) {
  sim::SceneRequest request{.name = options.scene, .samples = {}, .seed = seed};
  if (options.samples) {
    require_count("--samples", *options.samples, 1, 1e9);
    request.samples = static_cast<std::size_t>(*options.samples);
  }
  if (options.lights) request.lights = parse_lights(*options.lights);
  if (options.up) request.up = parse_up(*options.up);
  if (options.crease) request.crease = parse_crease(*options.crease);
  return sim::open_scene(request, stop);
}

std::string repeated_options(const AccuracyOptions& options) {
  std::string text;
  if (options.samples) text += fmt::format(" --samples {:.9g}", *options.samples);
  if (options.lights) text += " --light " + *options.lights;
  if (options.up) text += " --up " + *options.up;
  if (options.crease) text += " --crease " + *options.crease;
  if (options.front_facing) text += " --front-facing";
  if (options.discs) text += " --discs " + shell_word(*options.discs);
  return text;
}

/// The samples in question, if they are not all of the scene's at one radius.
struct Question {
  std::vector<double> radii;     ///< to try; none: by the mesh
  std::vector<double> relative;  ///< of the samples, over those
  std::vector<double> weights;   ///< of the samples
  std::string notice = {};       ///< if a run of the file would take other radii than the answer's
};

/// Makes the discs of a file the scene's samples.
Question take_question(sim::Scene& scene, const AccuracyOptions& options, const std::stop_token& stop) {
  Question question;
  const double side = scene.box.longest_side();
  const auto around = [](double radius) { return std::vector{radius / 2, radius, 2 * radius, 4 * radius}; };
  std::optional<double> radius;
  if (options.disc_radius) {
    const validate::Length length = validate::parse_length(*options.disc_radius);
    radius = length.relative ? length.value * side : length.value;
    question.radii = around(*radius);
  }
  if (options.discs) {
    if (options.samples) throw std::invalid_argument("the number of samples is for scenes; a disc file is taken whole");
    const double usual = radius.value_or(0.5 * sim::mean_edge_length(scene.mesh, stop));
    const std::vector<sim::Disc> discs = sim::read_discs(*options.discs, usual, stop);
    scene.samples.clear();
    std::vector<double> radii;
    for (const sim::Disc& disc : discs) {
      scene.samples.push_back({disc.centre, disc.normal});
      radii.push_back(disc.radius);
    }
    if (std::ranges::any_of(radii, [&](double one) { return one != usual; }))
      question.notice =
          *options.discs + " has radii, which detp run takes: for the radius of the answer, leave out that column";
    const double middle = validate::median(radii);
    question.radii = around(middle);
    question.weights = validate::weights_by_area(discs);
    for (const double one : radii) question.relative.push_back(one / middle);
  }
  if (options.faces.empty()) return question;
  if (question.weights.empty()) question.weights = validate::area_weights(scene, validate::Surfaces::all);
  validate::keep_named(question.weights, scene.mesh, scene.samples, options.faces, stop);
  return question;
}

constexpr std::array<std::string_view, 4> axis_names{"estimator", "simulation", "model", "arithmetic"};

void check_axes(const AccuracyOptions& options) {
  for (const std::string& axis : options.axes)
    static_cast<void>(one_of("--axis", axis, {axis_names.begin(), axis_names.end()}));
}

/// Of the axes that were asked for, without that of the estimators.
std::vector<validate::AxisPoint> other_axes(const AccuracyOptions& options, sim::Scene& scene, double radius,
                                            const validate::AccuracyPilotOptions& pilot) {
  constexpr std::size_t rays_of_model_axis = 200'000;
  const validate::AxisOptions axis{pilot.seed, pilot.threads, pilot.stop};
  const auto asked = [&](std::string_view name) { return std::ranges::find(options.axes, name) != options.axes.end(); };
  const auto discs = validate::discs_at(scene.samples, radius);
  std::vector<validate::AxisPoint> points;
  const auto add = [&](std::vector<validate::AxisPoint> more) { std::ranges::move(more, std::back_inserter(points)); };
  if (asked("simulation")) add(validate::simulation_axis(discs, axis));
  if (asked("model")) {
    const sim::Paths paths = validate::ReplicateMaker(scene, pilot.front_facing, pilot.threads, pilot.stop)
                                 .trace(rays_of_model_axis, pilot.seed, radius);
    add(validate::model_axis(paths, discs, validate::stored_unit_costs(Engine::simd), axis));
  }
  if (asked("arithmetic")) add(validate::arithmetic_axis(axis));
  return points;
}

/// The checkpoint of a command with these options, and what it has.
class KeptAccuracy {
 public:
  KeptAccuracy(const AccuracyOptions& options, const sim::Scene& scene, const validate::AccuracyTarget& target,
               double most_rays, std::uint64_t seed, const std::stop_token& stop) {
    if (!options.checkpoint) return;
    const validate::ReferenceKey key = validate::reference_key(scene, {.front_facing = options.front_facing});
    file_.emplace(*options.checkpoint, "accuracy",
                  Json{{"seed", seed},
                       {"digest of the scene", key.scene},
                       {"samples", scene.samples.size()},
                       {"facing", options.front_facing ? "front" : "any"},
                       {"target", target.value},
                       {"target of", target.kind == validate::AccuracyTarget::Kind::noise   ? "noise"
                                     : target.kind == validate::AccuracyTarget::Kind::total ? "error"
                                                                                            : "seconds"},
                       {"effort", options.effort},
                       {"check", options.check},
                       {"estimators", fmt::format("{}", fmt::join(options.estimators, ","))},
                       {"limit of rays", most_rays},
                       {"seeds of the runs", options.seeds.value_or("none")},
                       {"radius", options.disc_radius.value_or("none")},
                       {"materials", fmt::format("{}", fmt::join(options.faces.materials, ","))},
                       {"groups", fmt::format("{}", fmt::join(options.faces.groups, ","))},
                       {"reference", options.reference.value_or("none")}});
    if (options.resume) state = read_accuracy(*file_, stop);
  }

  void write() {
    if (file_) write_accuracy(*file_, state);
  }
  void write_if_due() {
    if (file_ && file_->due()) write();
  }

  SavedAccuracy state;

 private:
  std::optional<validate::CheckpointFile> file_;
};

/// Fills in pilot, plan and check, or takes them from the checkpoint. Returns how far it came if a stop request ended it.
std::optional<sim::Progress> find_answer(AccuracyAnswer& answer, sim::Scene& scene,
                                         const validate::AccuracyTarget& target, validate::AccuracyPilotOptions pilot,
                                         double most_rays, bool check, KeptAccuracy& saved) {
  const sim::Stopwatch watch;
  SavedAccuracy& state = saved.state;
  bool stopped = false;
  if (state.pilot) {
    answer.pilot = *state.pilot;
  } else {
    validate::PilotedPlan planned = validate::plan_accuracy(scene, target, pilot, most_rays);
    stopped = planned.stopped;
    answer.pilot = std::move(planned.pilot);
    state.planning_seconds = watch.seconds();
    if (!stopped) {  // else a resumed command makes the pilots that are missing
      state.pilot = answer.pilot;
      saved.write();
    }
  }
  answer.plan = validate::plan_accuracy(answer.pilot, target, most_rays);
  answer.seconds = state.planning_seconds;
  if (stopped) {
    answer.no_check = "Stopped before the check.";
    return sim::Progress{1, 3, "steps"};
  }
  if (!check) return std::nullopt;
  if (too_large(answer.plan.answer)) {
    answer.no_check = "Not run: too large for the memory.";
    return std::nullopt;
  }
  if (answer.plan.answer.seconds > longest_check) {
    answer.no_check = "Not run to check: too long.";
    return std::nullopt;
  }
  if (!state.check) try {
      const sim::Stopwatch of_check;
      pilot.seed += seeds_apart;
      if (pilot.progress) pilot.progress({"run to check", 0, 1, 0, answer.plan.answer.seconds});
      state.check =
          validate::check_accuracy(scene, answer.plan.answer, answer.pilot.mean_square, pilot, within_of(target));
      state.planning_seconds += of_check.seconds();
      saved.write_if_due();
    } catch (const sim::Stopped&) {
      answer.no_check = "Stopped before the check.";
      return sim::Progress{2, 3, "steps"};
    }
  answer.check = state.check;
  answer.checked = answer.plan.answer;
  answer.pilot = validate::with_check(answer.pilot, answer.plan.answer, *answer.check);
  answer.plan = validate::plan_accuracy(answer.pilot, target, most_rays);
  answer.seconds = state.planning_seconds;
  return std::nullopt;
}

Result run_accuracy(const AccuracyOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  const validate::AccuracyTarget target = target_of(options);
  const SeedRange seeds = options.seeds ? parse_seeds("--seeds", *options.seeds) : SeedRange{};
  if (options.seeds) validate::check_seeds(seeds.first, seeds.last);
  check_axes(options);
  const double most_rays = options.rays.value_or(1e9);
  require_count("--rays", most_rays, 1000, 1e12);
  validate::check(target, most_rays);
  const ProgressLine progress(common.quiet);
  sim::Scene scene = scene_of(options, common.seed, stop);
  if (scene.mesh.triangles.empty())
    throw std::invalid_argument(
        fmt::format("accuracy needs photon paths in a mesh; {} has no triangles", options.scene));
  const Question question = take_question(scene, options, stop);
  const bool thorough = options.effort == "thorough";
  validate::AccuracyPilotOptions pilot{.estimators = estimators_of(options),
                                       .radii = question.radii,
                                       .relative = question.relative,
                                       .weights = question.weights,
                                       .price = options.effort == "quick" ? 0.0
                                                : thorough                ? 20
                                                                          : 0.3,
                                       .least_price = thorough ? 20 : 0.5,
                                       .front_facing = options.front_facing,
                                       .seed = common.seed,
                                       .threads = common.threads,
                                       .stop = stop,
                                       .progress = progress.report(),
                                       .ranks = options.seeds ? common.ranks : nullptr};
  AccuracyAnswer answer{.scene = options.scene,
                        .options = repeated_options(options),
                        .pilot = {},
                        .plan = {},
                        .reference = {},
                        .check = {},
                        .checked = {},
                        .no_check = {},
                        .reruns = {},
                        .axes = {},
                        .in_time = {}};
  answer.side = scene.box.longest_side();
  answer.polygons = scene.mesh.polygons;
  answer.normals_made = scene.mesh.normals_made;
  answer.coincident = scene.mesh.coincident;
  const auto reference = [&] {
    return validate::kept_reference(
        *options.reference, scene,
        {.front_facing = options.front_facing, .threads = common.threads, .stop = stop, .progress = progress.report()});
  };
  if (options.reference) {
    if (common.ranks != nullptr)  // rank 0 makes it, unless there is one
      sim::do_on_all(*common.ranks, [&] {
        if (common.answers()) answer.reference = reference();
      });
    if (!answer.reference) answer.reference = reference();
    pilot.reference = &*answer.reference;
  }
  if (!common.answers()) {
    if (options.seeds) validate::serve_reruns(scene, pilot);
    return {};
  }
  if (common.ranks == nullptr) validate::probe_once(stop);
  KeptAccuracy saved(options, scene, target, most_rays, common.seed, stop);
  const auto say = [&](const std::string& text, const std::string& before) {
    note(common, before + text);
    answer.warnings.push_back(text);
  };
  for (const std::string& notice : scene.notices) say(notice, "");
  if (!question.notice.empty()) say(question.notice, "warning: ");
  if (question.weights.empty())
    if (const std::string notice = validate::mirror_notice(validate::mirror_share(scene.mesh)); !notice.empty())
      say(notice, "");
  std::optional<sim::Progress> stopped = find_answer(answer, scene, target, pilot, most_rays, options.check, saved);
  for (const std::string& warning : sim::light_warnings(answer.pilot.light, scene.lights)) say(warning, "warning: ");
  pilot.seed += seeds_apart;
  const validate::AccuracyPoint& best = answer.plan.answer;
  if (options.seeds && !stopped && !too_large(best)) {
    answer.reruns = validate::rerun_accuracy(scene, best, answer.pilot.mean_square, seeds.first, seeds.last, pilot,
                                             saved.state.runs, [&](const std::vector<validate::MadeRerun>& made) {
                                               saved.state.runs = made;
                                               saved.write_if_due();
                                             });
    if (const std::uint64_t all = seeds.last - seeds.first + 1; answer.reruns.size() < all)
      stopped = sim::Progress{answer.reruns.size(), all, "runs"};
  }
  if (stopped) saved.write();
  if (!stopped) try {
      answer.axes = other_axes(options, scene, answer.pilot.sample_distance, pilot);
    } catch (const sim::Stopped&) {
      stopped = sim::Progress{2, 3, "steps"};
    } catch (const std::exception& error) {  // the answer is complete without them
      say(fmt::format("no other axes: {}", error.what()), "warning: ");
    }
  answer.in_time =
      validate::plan_accuracy(answer.pilot, {validate::AccuracyTarget::Kind::seconds, 2 * best.seconds}, most_rays)
          .answer;
  answer.most_rays = most_rays;
  answer.threads = sim::useful_threads(common.threads);
  answer.whole = {.triangles = static_cast<double>(scene.mesh.triangles.size()),
                  .discs = static_cast<double>(scene.samples.size()),
                  .rays = best.rays,
                  .rays_in_memory = best.rays,
                  .traced = !gathers(best)};
  validate::add_file(options.scene, answer.whole);
  Result result;
  result.inputs = {
      {"scene", options.scene},
      {"target_noise", target.kind == validate::AccuracyTarget::Kind::noise ? Json(target.value) : Json()},
      {"target_error", target.kind == validate::AccuracyTarget::Kind::total ? Json(target.value) : Json()},
      {"time_budget", target.kind == validate::AccuracyTarget::Kind::seconds ? Json(target.value) : Json()},
      {"estimators", options.estimators},
      {"most_rays", most_rays},
      {"reference", options.reference ? Json(*options.reference) : Json()},
      {"axes", options.axes.empty() ? std::vector<std::string>{"estimator"} : options.axes},
      {"effort", options.effort},
      {"check", options.check},
      {"discs", options.discs ? Json(*options.discs) : Json()},
      {"disc_radius", question.radii.empty() ? Json() : Json(question.radii[1])},
      {"materials", options.faces.materials},
      {"groups", options.faces.groups},
      {"seeds", options.seeds ? Json(*options.seeds) : Json()},
      {"samples", scene.samples.size()},
      {"front_facing", options.front_facing}};
  if (options.crease) result.inputs["crease"] = parse_crease(*options.crease);
  result.json = to_json(answer);
  result.text = to_text(answer, common.screen());
  result.csv = csv_of(answer);
  result.stopped = stopped;
  result.not_reached = !answer.plan.reached;
  return result;
}

}  // namespace

Command accuracy_command(CLI::App& program) {
  CLI::App* app =
      program.add_subcommand("accuracy", "What accuracy costs in time: rays, setting and estimator for an error");
  app->footer("Example: detp accuracy @cornell --target-noise 5%\nExample: detp accuracy @cornell --time-budget 2");
  const auto options = std::make_shared<AccuracyOptions>();
  app->add_option("SCENE", options->scene, "a mesh (.obj, .ply) or a built-in scene with lights")->required();
  app->add_option("--target-noise", options->noise,
                  "noise to reach, as 5% or 0.05; the setting is the largest whose bias is below; default: 5%");
  app->add_option("--target-error", options->error, "noise and bias together to reach, as 5% or 0.05");
  add_number(*app, "--time-budget", options->seconds,
             "seconds that a run may take, tracing included: the most accurate");
  app->add_option("--estimators", options->estimators,
                  "a list of disc, variable-radius, nearest, area-corrected, triangle-hits, gather; default: all")
      ->delimiter(',');
  add_count(*app, "--rays", options->rays, "at most so many pieces of photon paths, as 10M; default: 1e9");
  add_count(*app, "--samples", options->samples, "how many samples; default: the scene's vertices");
  app->add_option("--discs", options->discs,
                  "the discs in question, from a CSV, PLY or NPY file; default: one at each of the scene's samples");
  app->add_option(
      "--disc-radius", options->disc_radius,
      "radii from half to four times this one are tried (a length, or a percentage); default: from a quarter "
      "to twice the mean edge of the mesh");
  add_face_names(*app, options->faces);
  app->add_option("--light", options->lights, "lights placed in the scene, as of run");
  app->add_option("--up", options->up, "which way is up, as of run");
  app->add_option("--crease", options->crease, "angle from which edges are sharp, as of run");
  app->add_option("--reference", options->reference,
                  "the file of the irradiance to compare with; it is made if there is none (up to a minute); "
                  "default: some backward paths");
  app->add_option("--seeds", options->seeds, "runs the answer again with each of these seeds, as 1:100; default: not");
  app->add_option(
         "--axis", options->axes,
         "what accuracy costs elsewhere, too: simulation (a hit probability by several ways to sample lines), model "
         "(what choosing knows at each rigor), arithmetic (float, double, exact); default: estimator alone")
      ->delimiter(',');
  app->add_option(
         "--effort", options->effort,
         "how long planning may take, until the bias is known to a fifth of the target: quick: 0.5 s; default: that or "
         "0.3 times the answer; thorough: 20 s or twenty times the answer; default: default")
      ->check(CLI::IsMember({"quick", "default", "thorough"}));
  app->add_flag("--check", options->check, "run the answer once; its noise is added to what is known; default: not");
  app->add_flag("--front-facing", options->front_facing, "light that arrives from behind does not count");
  app->add_option(
      "--checkpoint", options->checkpoint,
      "keep in this file the pilots and the runs of --seeds, so that the command can be killed; default: none");
  app->add_flag("--resume", options->resume, "go on from the checkpoint; default: begin anew");
  return {app,
          [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_accuracy(*options, common, stop);
          },
          true};
}

}  // namespace detp::cli
