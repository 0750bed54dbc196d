#include "accuracy_answer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "accuracy_state.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/photons/light_ledger.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "detp/validate/job/job.hpp"

namespace detp::validate {
namespace {

constexpr double longest_check = 60;         // seconds; a longer answer is not run
constexpr std::uint64_t seeds_apart = 1000;  // of pilots and of the check
constexpr std::size_t rays_of_model_axis = 200'000;

bool too_large_for_memory(const AccuracyPoint& point) {
  constexpr double bytes_of_a_ray = 3 * (sizeof(sim::Ray) + 20);
  return point.rays * bytes_of_a_ray > sim::memory_budget();
}

sim::Scene scene_in_question(const AccuracyRequest& request, const std::stop_token& stop) {
  sim::SceneRequest wanted = request.scene;
  wanted.crease = request.crease.value_or(wanted.crease);
  sim::Scene scene = sim::open_scene(wanted, stop);
  if (scene.mesh.triangles.empty())
    throw std::invalid_argument(
        fmt::format("accuracy needs photon paths in a mesh; {} has no triangles", request.scene.name));
  return scene;
}

/// What all runs share, but for the question.
AccuracyPilotOptions shared_options(const AccuracyRequest& request, const std::stop_token& stop,
                                    const sim::ReportPhase& progress) {
  const bool thorough = request.effort == PlanningEffort::thorough;
  return {.estimators = request.estimators,
          .price = request.effort == PlanningEffort::quick ? 0.0
                   : thorough                              ? 20
                                                           : 0.3,
          .least_price = thorough ? 20 : 0.5,
          .front_facing = request.front_facing,
          .seed = request.scene.seed,
          .threads = request.threads,
          .stop = stop,
          .progress = progress,
          .ranks = request.seeds ? request.ranks : nullptr};
}

/// Makes the discs of a file the scene's samples; takes radii and weights, if the question is not all samples at radii by the mesh. Returns a warning if a
/// run of the file would take other radii than the answer's.
std::string take_question(sim::Scene& scene, const AccuracyRequest& request, AccuracyPilotOptions& options) {
  std::string warning;
  const auto around = [](double radius) { return std::vector{radius / 2, radius, 2 * radius, 4 * radius}; };
  std::optional<double> radius;
  if (request.disc_radius) {
    const Length length = parse_length(*request.disc_radius);
    radius = length.relative ? length.value * scene.box.longest_side() : length.value;
    options.radii = around(*radius);
  }
  if (request.discs) {
    if (request.scene.samples)
      throw std::invalid_argument("the number of samples is for scenes; a disc file is taken whole");
    const double usual = radius.value_or(0.5 * sim::mean_edge_length(scene.mesh, options.stop));
    const std::vector<sim::Disc> discs = sim::read_discs(*request.discs, usual, options.stop);
    scene.samples.clear();
    std::vector<double> radii;
    for (const sim::Disc& disc : discs) {
      scene.samples.push_back({disc.centre, disc.normal});
      radii.push_back(disc.radius);
    }
    if (std::ranges::any_of(radii, [&](double one) { return one != usual; }))
      warning =
          *request.discs + " has radii, which detp run takes: for the radius of the answer, leave out that column";
    const double middle = median(radii);
    options.radii = around(middle);
    options.weights = weights_by_area(discs);
    for (const double one : radii) options.relative.push_back(one / middle);
  }
  if (request.faces.empty()) return warning;
  if (options.weights.empty()) options.weights = area_weights(scene, Surfaces::all);
  keep_named(options.weights, scene.mesh, scene.samples, request.faces, options.stop);
  return warning;
}

/// Of the request's file. Of ranks, the first one makes it, unless there is one.
std::optional<Reference> reference_in_file(const AccuracyRequest& request, const sim::Scene& scene,
                                           const AccuracyPilotOptions& options) {
  if (!request.reference) return std::nullopt;
  const auto read_or_made = [&] {
    return kept_reference(*request.reference, scene,
                          {.front_facing = options.front_facing,
                           .threads = options.threads,
                           .stop = options.stop,
                           .progress = options.progress});
  };
  std::optional<Reference> reference;
  if (request.ranks != nullptr)
    sim::do_on_all(*request.ranks, [&] {
      if (request.ranks->rank() == 0) reference = read_or_made();
    });
  return reference ? std::move(reference) : read_or_made();
}

/// All that decides what is found, and only that.
nlohmann::json key_of_accuracy(const AccuracyRequest& request, const sim::Scene& scene) {
  const auto joined = [](const auto& words) { return fmt::format("{}", fmt::join(words, ",")); };
  std::vector<std::string_view> estimators;
  for (const sim::Estimator one : request.estimators) estimators.push_back(name(one));
  return {
      {"seed", request.scene.seed},
      {"digest of the scene", reference_key(scene, {}).scene},
      {"samples", scene.samples.size()},
      {"facing", request.front_facing ? "front" : "any"},
      {"target", request.target.value},
      {"target of", name(request.target.kind)},
      {"effort", name(request.effort)},
      {"check", request.check},
      {"estimators", joined(estimators)},
      {"limit of rays", request.most_rays},
      {"seeds of the runs", request.seeds ? fmt::format("{}:{}", request.seeds->first, request.seeds->last) : "none"},
      {"radius", request.disc_radius.value_or("none")},
      {"materials", joined(request.faces.materials)},
      {"groups", joined(request.faces.groups)},
      {"reference", request.reference.value_or("none")}};
}

/// What was found so far, and its file if there is one.
class SavedAnswer {
 public:
  SavedAnswer(const AccuracyRequest& request, const sim::Scene& scene, const std::stop_token& stop) {
    if (!request.checkpoint) return;
    file_.emplace(*request.checkpoint, "accuracy", key_of_accuracy(request, scene));
    if (!request.resume) return;
    const auto saved = file_->read(stop);
    if (saved) try {
        found = saved->get<SavedAccuracy>();
      } catch (const nlohmann::json::exception& error) {
        throw file_->damaged(error.what());
      }
  }

  void write() {
    if (file_) file_->write(found);
  }
  void write_if_due() {
    if (file_ && file_->due()) write();
  }

  SavedAccuracy found;

 private:
  std::optional<CheckpointFile> file_;
};

/// Fills in pilot and plan, and how far it came if a stop request ended them.
void find_plan(AccuracyAnswer& answer, sim::Scene& scene, const AccuracyPilotOptions& options, SavedAnswer& saved) {
  const AccuracyRequest& request = answer.request;
  if (saved.found.pilot) {
    answer.pilot = *saved.found.pilot;
    answer.plan = plan_accuracy(answer.pilot, request.target, request.most_rays);
    return;
  }
  const sim::Stopwatch watch;
  PilotedPlan planned = plan_accuracy(scene, request.target, options, request.most_rays);
  answer.pilot = std::move(planned.pilot);
  answer.plan = std::move(planned.plan);
  saved.found.planning_seconds = watch.seconds();
  if (planned.stopped) {  // a resumed command makes the pilots that are missing
    answer.no_check = "Stopped before the check.";
    answer.stopped = sim::Progress{1, 3, "steps"};
    return;
  }
  saved.found.pilot = answer.pilot;
  saved.write();
}

/// Runs the answer, and plans again with what it says.
void check_plan(AccuracyAnswer& answer, sim::Scene& scene, AccuracyPilotOptions options, SavedAnswer& saved) {
  const AccuracyPoint& point = answer.plan.answer;
  if (too_large_for_memory(point))
    answer.no_check = "Not run: too large for the memory.";
  else if (point.seconds > longest_check)
    answer.no_check = "Not run to check: too long.";
  if (!answer.no_check.empty()) return;
  if (!saved.found.check) try {
      const sim::Stopwatch watch;
      options.seed += seeds_apart;
      if (options.progress) options.progress({"run to check", 0, 1, 0, point.seconds});
      saved.found.check = check_accuracy(scene, point, answer.pilot.mean_square, options, answer.within());
      saved.found.planning_seconds += watch.seconds();
      saved.write_if_due();
    } catch (const sim::Stopped&) {
      answer.no_check = "Stopped before the check.";
      answer.stopped = sim::Progress{2, 3, "steps"};
      return;
    }
  answer.check = saved.found.check;
  answer.check->point = point;
  answer.pilot = with_check(std::move(answer.pilot), *answer.check);
  answer.plan = plan_accuracy(answer.pilot, answer.request.target, answer.request.most_rays);
}

void run_again(AccuracyAnswer& answer, sim::Scene& scene, const AccuracyPilotOptions& options, SavedAnswer& saved) {
  const RerunSeeds& seeds = *answer.request.seeds;
  answer.reruns = rerun_accuracy(scene, answer.plan.answer, answer.pilot.mean_square, seeds, options, saved.found.runs,
                                 [&](const std::vector<AccuracyRerun>& made) {
                                   saved.found.runs = made;
                                   saved.write_if_due();
                                 });
  if (answer.reruns.size() < seeds.count()) answer.stopped = sim::Progress{answer.reruns.size(), seeds.count(), "runs"};
}

/// Of the axes that were asked for, without that of the estimators.
std::vector<AxisPoint> points_of_other_axes(const AccuracyAnswer& answer, sim::Scene& scene,
                                            const AccuracyPilotOptions& options) {
  const AxisOptions axis{options.seed + seeds_apart, options.threads, options.stop};
  const double radius = answer.pilot.sample_distance;
  const auto discs = discs_at(scene.samples, radius);
  std::vector<AxisPoint> points;
  const auto add = [&](AccuracyAxis asked, const auto& points_of) {
    if (std::ranges::find(answer.request.axes, asked) != answer.request.axes.end())
      std::ranges::move(points_of(), std::back_inserter(points));
  };
  add(AccuracyAxis::simulation, [&] { return simulation_axis(discs, axis); });
  add(AccuracyAxis::model, [&] {
    const sim::Paths paths = ReplicateMaker(scene, options.front_facing, options.threads, options.stop)
                                 .trace(rays_of_model_axis, axis.seed, radius);
    return model_axis(paths, discs, stored_unit_costs(Engine::simd), axis);
  });
  add(AccuracyAxis::arithmetic, [&] { return arithmetic_axis(axis); });
  return points;
}

/// What a run of the answer takes, and what twice its time buys.
void predict_run(AccuracyAnswer& answer, const sim::Scene& scene) {
  const AccuracyPoint& best = answer.plan.answer;
  answer.in_time =
      plan_accuracy(answer.pilot, {AccuracyTarget::Kind::seconds, 2 * best.seconds}, answer.request.most_rays).answer;
  WholeInputs inputs{.triangles = static_cast<double>(scene.mesh.triangles.size()),
                     .discs = static_cast<double>(scene.samples.size()),
                     .rays = best.rays,
                     .rays_in_memory = best.rays,
                     .traced = !best.gathers()};
  add_file(answer.request.scene.name, inputs);
  answer.whole = whole_seconds(inputs, {}, 0, 0);
  answer.whole.trace = best.trace_seconds;
  answer.whole.search = best.seconds - best.trace_seconds;
  answer.peak_bytes = peak_bytes(inputs, 0);
}

}  // namespace

std::size_t AccuracyAnswer::inside() const {
  const RootInterval& noise = plan.answer.noise;
  return static_cast<std::size_t>(std::ranges::count_if(
      reruns, [&](const AccuracyRerun& one) { return one.noise >= noise.low && one.noise <= noise.high; }));
}

AccuracyAnswer answer(const AccuracyRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress,
                      const std::function<void(const std::string&)>& note) {
  if (request.seeds) check(*request.seeds);
  check(request.target, request.most_rays);
  sim::Scene scene = scene_in_question(request, stop);
  AccuracyPilotOptions options = shared_options(request, stop, progress);
  const std::string warning = take_question(scene, request, options);
  const std::optional<Reference> reference = reference_in_file(request, scene, options);
  if (reference) options.reference = &*reference;
  AccuracyAnswer answer{.request = request,
                        .side = scene.box.longest_side(),
                        .samples = scene.samples.size(),
                        .polygons = scene.mesh.polygons,
                        .normals_made = scene.mesh.normals_made,
                        .coincident = scene.mesh.coincident};
  if (!options.radii.empty()) answer.disc_radius = options.radii[1];
  if (request.ranks != nullptr && request.ranks->rank() != 0) {
    if (request.seeds) serve_reruns(scene, options);
    return answer;
  }
  if (request.ranks == nullptr) probe_once(stop);
  SavedAnswer saved(request, scene, stop);
  const auto say = [&](const std::string& text, const std::string& before = "warning: ") {
    if (note && !text.empty()) note(before + text);
    if (!text.empty()) answer.warnings.push_back(text);
  };
  for (const std::string& notice : scene.notices) say(notice, "");
  say(warning);
  if (options.weights.empty()) say(mirror_notice(mirror_share(scene.mesh)), "");
  find_plan(answer, scene, options, saved);
  if (request.check && !answer.stopped) check_plan(answer, scene, options, saved);
  answer.planning_seconds = saved.found.planning_seconds;
  for (const std::string& lost : sim::light_warnings(answer.pilot.light, scene.lights)) say(lost);
  if (request.seeds && !answer.stopped && !too_large_for_memory(answer.plan.answer))
    run_again(answer, scene, options, saved);
  if (answer.stopped) saved.write();
  if (!answer.stopped) try {
      answer.axes = points_of_other_axes(answer, scene, options);
    } catch (const sim::Stopped&) {
      answer.stopped = sim::Progress{2, 3, "steps"};
    } catch (const std::exception& error) {  // the answer is complete without them
      say(fmt::format("no other axes: {}", error.what()));
    }
  predict_run(answer, scene);
  return answer;
}

}  // namespace detp::validate
