#include "run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "detp/model/optimum/best_ratio.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/photons/light_ledger.hpp"
#include "detp/validate/stopping/job_batches.hpp"
#include "run_to_target.hpp"

namespace detp::validate {
namespace {

/// The technique has all parameters that are fixed.
bool has_parameters(Technique technique, const model::FixedParameters& fixed) {
  return std::ranges::all_of(fixed.values,
                             [&](const auto& one) { return find_parameter(technique, one.first) != nullptr; });
}

/// "--leaf, --fan-out"
std::string names_of(const model::FixedParameters& fixed) {
  std::string names;
  for (const auto& one : fixed.values) names += fmt::format("{}--{}", names.empty() ? "" : ", ", one.first);
  return names;
}

/// The technique with all parameters, those that are not fixed by the closed forms.
Candidate complete(Technique technique, const RunRequest& request, const Workload& workload, const CostTable& costs) {
  auto candidate = model::complete(technique, request.parameters, workload, costs);
  if (!candidate) throw std::length_error(fmt::format("{} would not fit in memory on this workload", name(technique)));
  if (auto* cache = std::get_if<SphereCacheParameters>(&candidate->parameters);
      cache != nullptr && request.most_spheres)
    cache->spheres = model::own_spheres(workload, Form::corrected, {cache->ratio});
  return *candidate;
}

/// The fastest technique that has the fixed parameters, by the closed forms.
Candidate fastest_with_parameters(const RunRequest& request, const Workload& workload, const CostTable& costs,
                                  int threads) {
  std::optional<Prediction> best;
  for (const Technique technique : exact_techniques) {
    if (!model::has_closed_form(technique) || !has_parameters(technique, request.parameters)) continue;
    try {
      Prediction one = model::assess(workload, complete(technique, request, workload, costs), costs, threads);
      if (!best || one.time.total() < best->time.total()) best = std::move(one);
    } catch (const std::length_error&) {
    } catch (const std::invalid_argument&) {  // no closed form for these parameters
    }
  }
  if (!best)
    throw std::invalid_argument(
        fmt::format("no technique with {} can be predicted: give --technique, too", names_of(request.parameters)));
  return best->candidate;
}

/// The number of threads, at most `most_threads`, on which the closed form predicts the candidate to be fastest.
int chosen_threads(const Candidate& candidate, const Workload& workload, const CostTable& costs, int most_threads) {
  try {
    return model::assess(workload, candidate, costs, most_threads).threads;
  } catch (const std::invalid_argument&) {  // no closed form for these parameters
    return most_threads;
  }
}

/// What searches the job: the technique that is requested, or the fastest one. A pilot chooses where there are rays and nothing is fixed, else the closed
/// forms. The job is measured only if these choose. Estimators that search no pairs have no technique, and run on all threads.
RunCandidate choose_for(const RunRequest& request, const Job& job, const Question& question, const CostTable& costs) {
  const int all_threads = sim::thread_count(request.job.threads);
  const bool fixed = !request.parameters.values.empty() || request.most_spheres;
  if (!request.searches()) {
    if (request.estimator != sim::Estimator::nearest) return {{}, all_threads};
    return {model::candidate_with(Technique::photon_map, request.parameters), all_threads};
  }
  if (request.technique) {
    const Technique technique = *request.technique;
    if (!request.most_spheres && !model::is_open(technique, request.parameters))
      return {model::candidate_with(technique, request.parameters), all_threads};
    return {complete(technique, request, job.workload(), costs), all_threads};
  }
  if (!fixed && reachable_rigor(question, costs) == Rigor::pilot) {
    Choice choice = choose(question, request.costs);  // which prices sums of powers itself
    const Prediction& best = choice.best();
    return {best.candidate, best.threads, std::move(choice)};
  }
  const Workload& workload = job.workload();
  const int most = sim::useful_threads(request.job.threads);
  const Candidate candidate =
      fixed ? fastest_with_parameters(request, workload, costs, most)
            : complete(choose({.workload = workload, .threads = most}, costs).best().candidate.technique, request,
                       workload, costs);
  return {candidate, chosen_threads(candidate, workload, costs, most)};
}

/// What the request names and the candidate is not, as "leaf 16"; empty if it is all of it.
std::string missing_in(const Candidate& candidate, const RunRequest& request) {
  if (!request.searches()) return "";
  if (const Technique asked = request.technique.value_or(candidate.technique); asked != candidate.technique)
    return std::string(name(asked));
  for (const auto& asked : request.parameters.values) {
    const Parameter* const parameter = find_parameter(candidate.technique, asked.first);
    if (parameter == nullptr || parameter->get(candidate.parameters) != asked.second)
      return std::visit([&](const auto& one) { return fmt::format("{} {}", asked.first, one); }, asked.second);
  }
  return "";
}

sim::EstimateRequest estimate_request(const RunAnswer& answer, const Job& job) {
  sim::EstimateRequest request{.estimator = answer.request.estimator,
                               .candidate = answer.candidate,
                               .mesh = job.scene ? &job.scene->mesh : nullptr,
                               .scene = job.scene.get(),
                               .paths = answer.request.paths,
                               .seed = job.seed};
  if (const auto* map = std::get_if<PhotonMapParameters>(&answer.candidate.parameters)) {
    request.nearest = map->nearest;
    request.nearest_form = map->form;
  }
  return request;
}

/// Nothing if the run was stopped before its first ray.
std::optional<RaysTaken> taken_of(const sim::PhotonSource& source, const sim::Outcome& outcome) {
  const std::uint64_t rays = outcome.stopped ? outcome.progress.done : source.size();
  const std::uint64_t photons = source.photons_of(rays);
  if (photons == 0) return std::nullopt;
  return RaysTaken{static_cast<double>(rays), static_cast<double>(photons), source.light_of(photons)};
}

/// Photons of a job whose scene is kept.
LightOnFaces light_on_faces(const Job& job, sim::RunOptions options) {
  if (!job.scene || job.scene->mesh.triangles.empty())
    throw std::invalid_argument("--per-face needs a mesh: a scene with triangles");
  const sim::Mesh& mesh = job.scene->mesh;
  options.count = options.pairs = false;
  const auto sums = [&](const sim::SurfaceParts& parts) {
    sim::Outcome found = sim::sums_of_parts(job.paths(), mesh, parts, job.front_facing, options);
    if (found.stopped) throw sim::Stopped("stopped while light on faces was added up", found.progress);
    return found;
  };
  LightOnFaces faces{
      sums(sim::parts_by_triangle(mesh)), {sim::parts_by_material(mesh), {}}, {sim::parts_by_group(mesh), {}}};
  options.standard_error = true;
  for (LightOnParts* one : {&faces.by_material, &faces.by_group})
    if (!one->parts.areas.empty()) one->found = sums(one->parts);
  return faces;
}

/// What a run without hits met, and the likely reason.
std::string why_nothing(const Job& job, const RunAnswer& answer) {
  if (answer.request.gathers()) return fmt::format("no light: no path of {} discs finds a light", job.disc_count());
  std::string text =
      fmt::format("no hits: none of {} rays meets one of {} discs", answer.run.outcome.progress.of, job.disc_count());
  if (!job.light) return text + ": do the discs lie where the rays are, and are they large enough?";
  if (job.light->landings == 0) return text + ": no photon meets a surface";
  return text +
         fmt::format(
             ", although photons land {:.3g} times each: do discs lie where the light is? A disc whose normal is "
             "between those of the faces around, as at a corner that is smooth (--crease), lies beside them; "
             "--samples N adds samples on faces, and --estimator triangle-hits needs none",
             static_cast<double>(job.light->landings) / static_cast<double>(job.light->all_photons()));
}

}  // namespace

bool is_published(Technique technique) {
  return technique == Technique::sphere_cache || technique == Technique::sphere_cache_published ||
         technique == Technique::octree;
}

void check(const RunRequest& request) {
  const bool photon_map = request.technique == Technique::photon_map;
  const sim::Estimator estimator = request.estimator;
  if (request.technique && request.searches() == photon_map && !(photon_map && estimator == sim::Estimator::nearest))
    throw std::invalid_argument(fmt::format("the estimator {} does not use {}: leave out --technique or --estimator",
                                            name(estimator), name(*request.technique)));
  if (request.technique && !request.has_technique())
    throw std::invalid_argument(
        fmt::format("the estimator {} searches no pairs: leave out --technique", name(estimator)));
  if (request.technique || estimator == sim::Estimator::nearest) {
    const Technique technique = request.technique.value_or(Technique::photon_map);
    for (const auto& one : request.parameters.values)
      if (find_parameter(technique, one.first) == nullptr)
        throw std::invalid_argument(fmt::format("--{} is no parameter of {}", one.first, name(technique)));
    if (request.most_spheres && find_parameter(technique, "spheres") == nullptr)
      throw std::invalid_argument(fmt::format("--spheres is no parameter of {}", name(technique)));
  } else if (request.searches() && std::ranges::none_of(exact_techniques, [&](Technique one) {
               return has_parameters(one, request.parameters);
             }))
    throw std::invalid_argument(
        fmt::format("no exact technique has {}; give --technique", names_of(request.parameters)));
  if (request.form) {
    if (request.target)
      throw std::invalid_argument("--form changes the predicted counts; a run until an error has none");
    if (!request.technique) throw std::invalid_argument("--form is of one technique's formulas: give --technique");
    if (request.form == Form::published && !is_published(*request.technique))
      throw std::invalid_argument(
          fmt::format("the paper has no formulas for {}; it has for sphere-cache, sphere-cache-published and octree",
                      name(*request.technique)));
  }
  if (request.faces && request.gathers())
    throw std::invalid_argument("--per-face adds up photons that land; gather has none");
  if (request.faces && request.job.ranks != nullptr && request.job.ranks->count() > 1)
    throw std::invalid_argument("--per-face needs all photons in one process");
  if (!request.target) return;
  if (request.faces) throw std::invalid_argument("--per-face keeps all rays; a run until an error does not");
  require_batches(estimator);
  validate::check(request.target->error);
  if (request.pairs || request.repeat > 0)
    throw std::invalid_argument("a run until an error has no --pairs and --repeat");
}

JobRequest job_request(std::span<const RunRequest> requests) {
  const bool until = requests.front().target.has_value();
  const auto all = [&](auto what) { return std::ranges::all_of(requests, what); };
  JobRequest job = requests.front().job;
  if (until && !job.ray_file) job.rays = first_rays(job.rays.value_or(most_rays_by_default));
  job.stream = job.store_discs =
      !until && all([](const RunRequest& one) { return one.estimator == sim::Estimator::disc && !one.faces; });
  job.keep_scene = until || !all([](const RunRequest& one) {
                     return !one.keep_scene && !one.faces && !sim::record_of(one.estimator).needs_mesh() &&
                            !sim::record_of(one.estimator).needs_scene;
                   });
  job.landings = !all([](const RunRequest& one) { return one.searches() && !one.faces; });
  job.without_rays = all([](const RunRequest& one) { return one.gathers(); });
  job.in_batches = until;
  return job;
}

RunAnswer answer(const Job& job, const RunRequest& request, const std::stop_token& stop,
                 const sim::ReportPhase& progress) {
  sim::Ranks* const ranks = job.stream || request.target ? request.job.ranks : nullptr;  // that share the search
  if (ranks == nullptr && !request.answers()) return {};
  const Question question{.problem = job.stream ? nullptr : &job.problem(),
                          .effects = job.measuring.effects,
                          .surface = &job.surface,
                          .purpose = Purpose::one_search,
                          .threads = request.job.threads,
                          .stop = stop};
  RunAnswer answer{.request = request, .whole = whole_inputs(request.job, job, job.given.rays)};
  answer.request.costs = costs_for(question, request.costs);
  const auto choose = [&] { return choose_for(request, job, question, answer.request.costs); };
  if (request.target) {
    const auto missing = [&](const Candidate& candidate) { return missing_in(candidate, request); };
    run_to_target(answer, job, {choose, missing}, stop, progress, ranks);
    return answer;
  }
  RunCandidate chosen = agreed(ranks, choose);
  answer.candidate = chosen.candidate;
  answer.threads = chosen.threads;
  answer.choice = std::move(chosen.choice);
  sim::RunOptions run{.pairs = request.pairs, .engine = request.engine, .stop = stop, .threads = answer.threads};
  run.standard_error = request.standard_error;
  const Together together{ranks, request.share};
  const double share_of_first = 1.0 / (1 + request.repeat);
  const sim::EstimateRequest estimate = estimate_request(answer, job);
  answer.run = run_job(job, estimate, run, sim::part_of(progress, 0, share_of_first), together,
                       answer.choice ? &*answer.choice : nullptr);
  if (job.photon_stream && request.answers()) answer.taken = taken_of(*job.photon_stream, answer.run.outcome);
  run.count = run.pairs = false;
  if (request.faces && !answer.run.outcome.stopped) try {
      answer.faces = light_on_faces(job, run);
    } catch (const sim::Stopped& stopped) {
      answer.run.outcome.stopped = true;
    }
  answer.timing = time_runs(job, estimate, answer.run, answer.run.outcome.stopped ? 0 : request.repeat, run,
                            sim::part_of(progress, share_of_first, 1), together);
  return answer;
}

JobAndRun answer(const RunRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress) {
  constexpr double share_of_job = 0.3;
  check(request);
  JobAndRun both{make_job(job_request({&request, 1}), stop, sim::part_of(progress, 0, share_of_job)), {}};
  both.answer = answer(both.job, request, stop, sim::part_of(progress, share_of_job, 1));
  return both;
}

std::vector<std::string> answer_warnings(const Job& job, const RunAnswer& answer) {
  std::vector<std::string> all;
  if (answer.taken && answer.taken->light) all = sim::light_warnings(*answer.taken->light, job.lights);
  if (!answer.run.outcome.stopped && answer.run.outcome.total_hits == 0) all.push_back(why_nothing(job, answer));
  if (const sim::MissedShare& missed = answer.run.missed; missed.upper_bound > 0)
    all.push_back(
        fmt::format("{:.2g} % of the light on surfaces is missing, at most {:.2g} % (95 %, {} photons): it comes from "
                    "point, spot or directional lights by way of mirrors, gloss or glass, where no backward path "
                    "finds it; --estimator area-corrected has it",
                    100 * missed.share, 100 * missed.upper_bound, missed.photons));
  return all;
}

std::optional<RaysTaken> taken_by(const Job& job, const RunAnswer& answer) {
  if (!answer.until) return answer.taken;
  const UntilResult& result = answer.until->result;
  return RaysTaken{static_cast<double>(result.rays), result.photons,
                   job.light ? std::optional(answer.until->light) : std::nullopt};
}

}  // namespace detp::validate
