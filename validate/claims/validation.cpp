#include "validation.hpp"

#include <algorithm>
#include <stdexcept>

#include "detp/validate/answer/parts.hpp"

namespace detp::validate {
namespace {

constexpr double default_lines = 1e6;
constexpr double share_of_claims = 0.03;  ///< of the time of a validation with a sweep

std::vector<ExperimentStep> steps_of(const ValidateRequest& request) {
  std::vector<ExperimentStep> steps;
  for (const ExperimentStep& step : experiment_steps())
    if (request.experiments.empty() || std::ranges::find(request.experiments, step.key) != request.experiments.end())
      steps.push_back(step);
  return steps;
}

std::string effects_on(const std::vector<sim::EffectReport>& effects) {
  std::string on;
  for (const sim::EffectReport& report : effects)
    if (report.on) on += (on.empty() ? "" : ", ") + std::string(report.effect->name);
  return on;
}

Experiment uniform_experiment(JobRequest request, ValidateAnswer& answer) {
  if (request.front_facing || request.field.value_or(sim::Field::isotropic) != sim::Field::isotropic)
    throw std::invalid_argument("--front-facing and --field photons take a scene or --discs; numbers alone mean lines");
  if (!request.rays) request.rays = default_lines;
  if (!request.samples) request.samples = 20'000;
  if (!request.disc_radius) request.disc_radius = Length{0.02};
  if (!request.sphere_radius && !request.scene_side) request.scene_side = 2;
  Experiment experiment{.workload = workload_of_numbers(request), .discs = {}};
  if (experiment.workload.samples > 1e7)
    throw std::length_error("validate draws 32 sets of samples; at most 1e7 samples are allowed");
  answer.inputs = numbers_json(experiment.workload);
  answer.inputs["samples_are"] = "uniform";
  answer.effects = sim::effects_of_numbers(experiment.workload);
  return experiment;
}

/// The workload with isotropic lines instead of its rays.
Workload with_lines(Workload workload, double lines) {
  workload.rays = lines;
  workload.rays_end = workload.front_facing = false;
  workload.path_length = 0;
  workload.ray_density = workload.hit_ratio = 1;
  return workload;
}

/// `choice` has the workload and rays of `choose` with the same request. The other claims are about isotropic lines: as many as the rays asked
/// for, or default_lines.
Experiment scene_experiment(const ValidateRequest& request, const std::stop_token& stop, ValidateAnswer& answer) {
  Job job = make_job(request.job, stop);
  if (request.made) request.made(job);
  answer.scene = ledgers_json(job);
  answer.scene["warnings"] = job.all_said();
  answer.inputs = to_json(job, request.job);
  answer.effects = job.observed().effects;
  Experiment experiment{.workload = with_lines(job.workload(), request.job.rays.value_or(default_lines)), .discs = {}};
  experiment.choice = {job.workload(), std::move(job.rays), effects_on(answer.effects)};
  experiment.discs = std::move(job.discs);
  answer.inputs["lines"] = whole(experiment.workload.rays);
  return experiment;
}

Experiment make_experiment(const ValidateRequest& request, const std::stop_token& stop, ValidateAnswer& answer) {
  Experiment experiment =
      request.job.numbers_alone() ? uniform_experiment(request.job, answer) : scene_experiment(request, stop, answer);
  experiment.stop = stop;
  experiment.seed = request.job.seed;
  experiment.ranks = request.ranks;
  if (!request.ratios.empty()) experiment.ratios = request.ratios;
  answer.inputs["ratio"] = experiment.ratios;
  answer.inputs["seed"] = request.job.seed;
  answer.inputs["form"] = request.form ? Json(name(*request.form)) : Json();
  if (const auto& until = request.until)
    answer.inputs.update({{"until_relative_error", until->relative_error},
                          {"confidence", until->confidence},
                          {"min_lines", until->least_lines},
                          {"max_lines", until->most_lines}});
  return experiment;
}

std::vector<SweepPoint> points_of(const ValidateRequest& request) {
  std::vector<SweepPoint> points = sweep_points();
  std::erase_if(points, [&](const SweepPoint& point) { return point.samples > *request.sweep_samples; });
  return points;
}

void find(const ValidateRequest& request, const Experiment& experiment, const std::vector<ExperimentStep>& steps,
          const sim::ReportPhase& progress, ValidateAnswer& answer) {
  if (!request.until) {
    sim::Progress done;
    answer.findings = all_findings(experiment, progress, &done, steps);
    if (done.done < done.of) answer.stopped = done;
    return;
  }
  FindingsUntil until = findings_until(experiment, *request.until, steps, request.checkpoint, request.resume, progress);
  answer.findings = std::move(until.findings);
  const auto reached =
      std::ranges::count_if(answer.findings, [](const Finding& one) { return one.refinement->reached; });
  if (until.stopped)
    answer.stopped = sim::Progress{static_cast<std::uint64_t>(reached), answer.findings.size(), "counts"};
  answer.not_reached = !until.stopped && std::ranges::any_of(answer.findings, [](const Finding& one) {
    return one.refinement->more_lines.has_value();
  });
}

Json verdicts_json(const Claims& claims) {
  Json json;
  for (const Verdict verdict : {Verdict::agrees, Verdict::refuted, Verdict::undecided})
    json[std::string(name(verdict))] = with_verdict(claims, verdict).size();
  return json;
}

/// The numbers of verdicts on corrected forms, published forms, controls and the predictions of the choice.
Json summary_json(const Claims& claims) {
  const Claims published = with_form(claims, Form::published);
  Json json{{"corrected", verdicts_json(with_form(claims, Form::corrected))}, {"published", verdicts_json(published)}};
  json["published"]["documented"] = std::ranges::count(published, true, &Claim::documented);
  for (const Verdict verdict : {Verdict::refuted, Verdict::agrees, Verdict::undecided})
    json["controls"][std::string(control_name(verdict))] = controls(claims, verdict);
  const std::vector<std::string> techniques = judged_candidates(claims);
  if (techniques.empty()) return json;
  const Claims of_choice = of_candidate(claims, techniques.front());
  Json& choice = json["choice"] = verdicts_json(of_choice);
  choice["technique"] = techniques.front();
  choice["parameters"] = of_choice.front().parameters;
  choice["refuted_claims"] = Json::array();
  for (const Claim& claim : with_verdict(of_choice, Verdict::refuted)) choice["refuted_claims"].push_back(claim.id);
  return json;
}

Json words_or_null(const std::string& words) { return words.empty() ? Json() : Json(words); }

/// Of claims that were counted until their error was small.
const Fields<Refinement>& refinement_fields() {
  static const Fields<Refinement> fields{
      {"relative_error", "", "half width of the interval, over observed", &Refinement::relative_error},
      {"reached", "", "relative_error is as small as asked", &Refinement::reached},
      {"more_lines", "", "that the error would still take, by what is known", &Refinement::more_lines},
      {"more_seconds", "s", "that these lines would take", &Refinement::more_seconds},
      {"share_bound", "", "if nothing was met: bound of the share of lines that meet anything",
       &Refinement::share_bound}};
  return fields;
}

/// Of a claim's candidate: the last columns.
const Fields<Claim>& searched_fields() {
  static const Fields<Claim> fields{{"technique", "", "null if the claim is about lines alone",
                                     [](const Claim& claim) { return words_or_null(claim.technique); }},
                                    {"parameters", "", "null if the claim is about several candidates or none",
                                     [](const Claim& claim) { return words_or_null(claim.parameters); }}};
  return fields;
}

/// Columns that are not among the first are added.
Columns with_new(Columns columns, const Columns& others) {
  for (const std::string& one : others)
    if (std::ranges::find(columns, one) == columns.end()) columns.push_back(one);
  return columns;
}

}  // namespace

const Fields<Claim>& claim_fields() {
  static const Fields<Claim> fields =
      Fields<Claim>{
          {"id", "", "the quantity, and the form of the formula", &Claim::id},
          {"quantity", "", "what is predicted and counted", &Claim::quantity},
          {"form", "", "published: the paper's formula; corrected: ours",
           [](const Claim& one) { return name(one.form); }},
          {"source", "", "equation of the paper, or our derivation", &Claim::source},
          {"predicted", "", "by the formula", &Claim::predicted},
          {"observed", "", "counted", [](const Claim& one) { return one.observed.mean; }},
          {"standard_error", "", "of observed", [](const Claim& one) { return one.observed.standard_error; }},
          {"relative_difference", "", "observed over predicted, less 1", &Claim::relative_difference},
          {"tolerance", "", "relative difference that still counts as agreement", &Claim::tolerance},
          {"detectable", "", "relative error of the formula that would be refuted with 97 %", &Claim::detectable},
          {"verdict", "", "agrees, refuted or undecided", [](const Claim& one) { return name(one.verdict); }},
          {"documented", "", "the corrected form says what is wrong in this published form", &Claim::documented},
          Field<Claim>("control", "", "the same formula with an error that is just detectable; should be caught",
                       [](const Claim& one) {
                         return Json{{"offset", known(one.control_offset)},
                                     {"predicted", known(one.control)},
                                     {"verdict", control_name(one.control_verdict)}};
                       })
              .in({{"control_offset", "/offset"},
                   {"control_predicted", "/predicted"},
                   {"control_verdict", "/verdict"}}),
          {"lines", "", "that were counted on", &Claim::lines},
          {"seconds", "s", "of the experiment", &Claim::seconds}} +
      fields_of_part<Claim>(refinement_fields(), &Claim::refinement);
  return fields;
}

namespace {

Json claims_json(const ValidateAnswer& answer) {
  Json json = Json::array();
  for (const Claim& claim : answer.shown) {
    json.push_back(json_of(claim_fields(), claim));
    json.back().update(json_of(searched_fields(), claim));
  }
  return json;
}

Json sweep_json(const SweepResult& sweep) {
  return {{"points", sweep.points},
          {"measured", sweep.measured},
          {"resumed", sweep.resumed},
          {"summary", rows_json(summary_fields(), summarise(sweep.deviations))}};
}

const Fields<ValidateAnswer>& answer_fields() {
  using Answer = ValidateAnswer;
  constexpr FieldPlace alone = FieldPlace::json_alone;
  static const Fields<Answer> fields{
      {"effects", "", "on a scene: what predictions take into account, and why",
       [](const Answer& answer) { return to_json(answer.effects); }, alone},
      {"summary", "", "numbers of verdicts on corrected forms, published forms, controls and predictions of the choice",
       [](const Answer& answer) { return summary_json(answer.claims); }, alone},
      {"claims", "", "each prediction beside what was counted", claims_json, alone},
      {"sweep", "", "of --effort thorough: each quantity over its whole range", of_part(&Answer::sweep, sweep_json),
       alone}};
  return fields;
}

}  // namespace

std::vector<FieldText> describe_validate() {
  return describe_fields(answer_fields()) + describe_fields(claim_fields()) + describe_fields(searched_fields()) +
         describe_fields(summary_fields()) + describe_fields(deviation_fields());
}

bool ValidateAnswer::refuted() const {
  return !with_verdict(with_form(claims, Form::corrected), Verdict::refuted).empty() ||
         controls(claims, Verdict::agrees) > 0;
}

ValidateAnswer answer(const ValidateRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress) {
  if (request.sweep_samples && request.until)
    throw std::invalid_argument("give one of --effort thorough and --until-relative-error");
  if (!request.sweep_samples && !request.until && (request.checkpoint || request.resume))
    throw std::invalid_argument("--checkpoint and --resume belong to --effort thorough and to --until-relative-error");
  if (request.sweep_samples && !request.job.numbers_alone())
    throw std::invalid_argument("--effort thorough has workloads of its own; it takes no scene");
  if (request.until) check(*request.until);
  const bool alone = request.ranks == nullptr || request.ranks->rank() == 0;
  SweepOptions sweep{.seed = request.job.seed,
                     .checkpoint = request.checkpoint,
                     .resume = request.resume,
                     .stop = stop,
                     .progress = sim::part_of(progress, share_of_claims, 1)};
  if (alone && request.sweep_samples) check_checkpoint(points_of(request), sweep);
  const std::vector<ExperimentStep> steps = steps_of(request);
  ValidateAnswer answer;
  const Experiment experiment = make_experiment(request, stop, answer);
  if (!alone) {
    serve_findings(experiment, steps);
    return {};
  }
  find(request, experiment, steps, sim::part_of(progress, 0, request.sweep_samples ? share_of_claims : 1), answer);
  answer.claims = judge_all(answer.findings);
  answer.shown = request.form ? with_form(answer.claims, *request.form) : answer.claims;
  if (!request.sweep_samples || answer.stopped) return answer;
  answer.sweep = run_sweep(points_of(request), sweep);
  if (answer.sweep->measured < answer.sweep->points)
    answer.stopped = {answer.sweep->measured, answer.sweep->points, "workloads of the sweep"};
  return answer;
}

Json json_of(const ValidateAnswer& answer) {
  Json json = answer.scene;
  json.update(json_of(answer_fields(), answer));
  return json;
}

Columns validate_columns() {
  return with_new(workload_columns() + columns_of(claim_fields()) + effect_columns() + columns_of(searched_fields()),
                  columns_of(deviation_fields()));
}

std::vector<Json> validate_rows(const ValidateAnswer& answer) {
  Json shared = workload_cells(answer.inputs);
  shared.update(effect_cells(to_json(answer.effects)));
  std::vector<Json> rows;
  for (const Claim& claim : answer.shown) {
    Json& row = rows.emplace_back(shared);
    row.update(cells_of(claim_fields(), claim));
    row.update(cells_of(searched_fields(), claim));
  }
  if (answer.sweep)
    for (const Deviation& deviation : answer.sweep->deviations) rows.push_back(cells_of(deviation_fields(), deviation));
  return rows;
}

}  // namespace detp::validate
