#include "workload_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "detp/model/vocabulary/nearest_name.hpp"
#include "detp/model/vocabulary/quoted.hpp"

namespace detp::cli {
namespace {

constexpr std::string_view spheres_option = "spheres";

std::vector<std::string_view> technique_names() {
  std::vector<std::string_view> names;
  for (const Technique technique : all_techniques) names.push_back(name(technique));
  return names;
}

std::string known_techniques() { return fmt::format("{}", fmt::join(technique_names(), ", ")); }

/// The option for a parameter that one or more techniques have. `help` has its meaning for each of these techniques.
struct SharedParameter {
  const Parameter* parameter;
  std::string help;
};

/// All parameters in the order of the techniques, one for each name.
std::vector<SharedParameter> shared_parameters() {
  std::vector<SharedParameter> all;
  for (const TechniqueRecord& record : technique_records)
    for (const Parameter& parameter : record.parameters) {
      const auto same = std::find_if(all.begin(), all.end(),
                                     [&](const SharedParameter& one) { return one.parameter->name == parameter.name; });
      if (same == all.end())
        all.push_back({&parameter, std::string(parameter.help)});
      else if (same->help.find(parameter.help) == std::string::npos)
        same->help += fmt::format("; {}", parameter.help);
    }
  return all;
}

/// The effects that --effects switches.
std::string switched_effects() {
  std::vector<std::string> names;
  for (const sim::Effect* effect : sim::all_effects)
    if (!effect->is_input) names.push_back(sim::option_name(*effect));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// 100000 as "100 000".
std::string spaced(double count) {
  std::string digits = fmt::format("{:.0f}", count);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), " ");
  return digits;
}

}  // namespace

void require_numbers(const validate::JobRequest& request) {
  const auto need = [](bool given, std::string_view what, std::string_view option) {
    if (!given) throw std::invalid_argument(fmt::format("without a scene, {} is needed: {}", what, option));
  };
  if (!request.samples && !request.disc_radius && !request.sphere_radius && !request.scene_side)
    throw std::invalid_argument(
        "a scene is needed (a mesh, or a built-in one as @tree); or --discs FILE and --ray-file FILE; or numbers: "
        "--samples N --disc-radius d --scene-side s");
  need(request.samples.has_value(), "the number of samples", "--samples N");
  need(request.disc_radius.has_value(), "the disc radius", "--disc-radius d");
  need(request.sphere_radius || request.scene_side, "its size", "--sphere-radius r0 or --scene-side s");
}

std::string_view name(sim::Field field) {
  if (field == sim::Field::mixed) return "mixed";
  return field == sim::Field::isotropic ? "isotropic" : "photons";
}

std::pair<sim::Field, sim::FieldShares> parse_field(const std::string& text) {
  if (!text.starts_with("mixed")) {
    const bool lines = one_of("--field", text, {"isotropic", "photons", "mixed"}) == "isotropic";
    return {lines ? sim::Field::isotropic : sim::Field::photons, {}};
  }
  sim::FieldShares shares{1.0 / 3, 1.0 / 3, 1.0 / 3};
  if (text != "mixed") {
    std::vector<double> numbers;
    std::size_t from = std::string_view("mixed").size();
    while (from < text.size() && text[from] == ':') {
      const std::size_t end = std::min(text.find(':', from + 1), text.size());
      if (end == from + 1) break;  // an empty share
      numbers.push_back(parse_number("--field", text.substr(from + 1, end - from - 1)));
      from = end;
    }
    if (numbers.size() != 3 || from != text.size())
      throw std::invalid_argument(
          fmt::format("--field {}: a mixture is mixed, or mixed:ISOTROPIC:DIRECTIONAL:POINT with three shares",
                      detp::quoted(text)));
    shares = {numbers[0], numbers[1], numbers[2]};
  }
  sim::check(shares);
  return {sim::Field::mixed, shares};
}

void WorkloadOptions::add_to(CLI::App& command, Values values, std::optional<Values> axes) {
  using enum ValueLists::Kind;
  command.add_option("SCENE", request_.scene,
                     "a mesh (.obj, .ply) or @uniform, @tree, @tree-coarse, @courtyard, @cornell, @caustic, "
                     "@interior");
  command.add_option("--discs", request_.disc_file,
                     "discs from a CSV or PLY file; default: one at each of the scene's samples");
  command.add_option("--ray-file", request_.ray_file, "rays from a CSV or PLY file; default: made, as --field says");
  lists.add_count(command, "--rays", axes.value_or(values), request_.rays, "how many rays, as 100k; default: 100k");
  lists.add_count(command, "--samples", values, request_.samples,
                  "how many samples; default: the scene's vertices, with numbers alone none");
  lists.add(
      command, "--disc-radius", axes.value_or(values), numbers,
      [this](const std::string& text) { request_.disc_radius = validate::parse_length(text); },
      "d: a length, or a percentage of the scene's longest side; default: half the distance between samples");
  lists.add(command, "--sphere-radius", values, request_.sphere_radius,
            "r0, of a workload in numbers; default: by --scene-side");
  lists.add(command, "--scene-side", values, request_.scene_side,
            "s, of a workload in numbers: r0 = s sqrt(3)/2 + d; default: by --sphere-radius");
  lists.add(command, "--dimension", values, request_.dimension,
            "D of the samples: 3 fill a volume, 2 lie on surfaces; default: measured, with numbers alone 3");
  lists.add(command, "--sample-extent", values, request_.sample_extent,
            "volume or area that the samples fill; default: the whole cube or its faces");
  lists.add(
      command, "--field", values, words,
      [this](const std::string& text) {
        const auto [field, shares] = parse_field(text);
        request_.field = field;
        request_.shares = shares;
      },
      "isotropic (lines), photons (paths from the scene's lights), or mixed: lines, parallel lines straight down and "
      "segments from the top, a third each, or as mixed:0.5:0.25:0.25 says; default: photons where there is a light");
  lists.add(
      command, "--light", Values::one, words, [this](const std::string& text) { request_.lights = parse_lights(text); },
      "lights placed in the scene, a list of area, point, spot, directional, environment, surface (materials that "
      "emit); default: the scene's own lights, or an area light");
  lists.add(
      command, "--up", Values::one, words, [this](const std::string& text) { request_.up = parse_up(text); },
      "which way is up, for lights that are placed: x, y, z, -x, -y, -z, auto; default: auto (by the mesh's shape)");
  command.add_flag("--front-facing", request_.front_facing, "count only rays that arrive at a disc's front");
  lists.add(
      command, "--effects", Values::one, words,
      [this](const std::string& text) { request_.effects = sim::EffectSelection(text); },
      fmt::format(
          "deviations from uniform lines and samples that are taken into account: auto (where the evidence calls "
          "for them), none, all, or a list of {}; default: auto",
          switched_effects()));
}

std::vector<sim::LightKind> parse_lights(std::string_view text) {
  std::vector<std::string_view> names;
  for (const sim::LightKind kind : sim::light_kinds) names.push_back(name(kind));
  std::vector<sim::LightKind> lights;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string word = one_of("--light", std::string(text.substr(from, comma - from)), names);
    lights.push_back(sim::light_kinds[static_cast<std::size_t>(std::ranges::find(names, word) - names.begin())]);
    from = comma + 1;
  }
  return lights;
}

std::optional<sim::Up> parse_up(const std::string& text) {
  std::vector<std::string_view> names;
  for (const auto& [known, up] : sim::named_ups) names.push_back(known);
  names.emplace_back("auto");
  const std::string word = one_of("--up", text, names);
  if (word == "auto") return std::nullopt;
  return std::ranges::find(sim::named_ups, word, &std::pair<std::string_view, sim::Up>::first)->second;
}

validate::JobRequest WorkloadOptions::request(const CommonOptions& common, bool complete) const {
  validate::JobRequest request = request_;
  request.seed = common.seed;
  request.threads = common.threads;
  if (!request.numbers_alone() && (request.sphere_radius || request.scene_side))
    throw std::invalid_argument(
        "--sphere-radius and --scene-side describe a workload in numbers; a scene has its own size");
  if (complete && request.numbers_alone()) require_numbers(request);
  return request;
}

void CandidateOptions::add_to(CLI::App& command, Values values, SphereStop default_stop) {
  const bool of_model = default_stop == SphereStop::max;  // else of `run`
  using enum ValueLists::Kind;
  lists.add(
      command, "--technique", values, words, [this](const std::string& text) { technique = text; },
      fmt::format("{}; default: {}", known_techniques(),
                  of_model ? name(Technique::sphere_cache)
                           : "chosen by a pilot; for short searches by the numbers of rays and discs; for streams of "
                             "rays and --engine plain by the closed forms"));
  for (const auto& [parameter, about] : shared_parameters()) {
    std::string help = about;
    if (!parameter->choices.empty()) help += fmt::format(": {}", fmt::join(parameter->choices, ", "));
    if (parameter->name != spheres_option)
      help +=
          of_model
              ? "; default: the paper's rule for sphere-cache, octree and grid, else the fastest by the closed forms"
              : "; default: chosen with the technique; with --technique the fastest by the closed forms";
    else
      help += fmt::format(", as a number; max: the form's own; best: the fastest by the closed forms; default: {}",
                          of_model ? "max" : "best");
    lists.add(
        command, fmt::format("--{}", parameter->name), values, parameter->choices.empty() ? numbers : words,
        [this, one = parameter](const std::string& text) { set(*one, text); }, help);
  }
  lists.add(
      command, "--engine", values, words, [this](const std::string& text) { engine = parse_engine(text); },
      engine_help);
}

Engine parse_engine(const std::string& text) {
  return *choice_named<Engine>(one_of("--engine", text, {"plain", "simd"}));
}

void CandidateOptions::set(const Parameter& parameter, const std::string& text) {
  const std::string option = fmt::format("--{}", parameter.name);
  given_.erase(parameter.name);
  if (parameter.name == spheres_option) {
    stop.reset();
    if (text == "max") stop = SphereStop::max;
    if (text == "best") stop = SphereStop::best;
    if (stop) return;
  }
  if (!parameter.choices.empty()) {
    const std::string word = one_of(option, text, {parameter.choices.begin(), parameter.choices.end()});
    given_[parameter.name] = *std::find(parameter.choices.begin(), parameter.choices.end(), word);
  } else if (std::holds_alternative<double>(parameter.small)) {
    given_[parameter.name] = parse_number(option, text);
  } else {
    given_[parameter.name] = parse_whole(option, text);
  }
}

Technique parse_technique(const std::string& text) {
  const auto found = technique_named(text);
  if (!found)
    throw std::invalid_argument(fmt::format("there is no technique {}; there are {}{}", detp::quoted(text),
                                            known_techniques(), did_you_mean(text, technique_names())));
  return *found;
}

model::FixedParameters CandidateOptions::fixed_parameters(Technique chosen) const {
  const auto require_known = [&](std::string_view parameter) {
    if (find_parameter(chosen, parameter) == nullptr)
      throw std::invalid_argument(fmt::format("--{} is no parameter of {}", parameter, detp::name(chosen)));
  };
  model::FixedParameters fixed;
  for (const auto& [parameter, value] : given_) {
    require_known(parameter);
    fixed.values.emplace_back(parameter, value);
  }
  if (stop) require_known(spheres_option);
  return fixed;
}

Json names_json(const std::vector<Technique>& techniques) {
  Json names = Json::array();
  for (const Technique technique : techniques) names.push_back(name(technique));
  return names;
}

Json to_json(const Workload& workload) {
  return {{"rays", whole(workload.rays)},
          {"samples", whole(workload.samples)},
          {"disc_radius", workload.disc_radius},
          {"sphere_radius", workload.sphere_radius},
          {"scene_side", scene_side(workload)},
          {"box", workload.box},
          {"dimension", workload.dimension},
          {"sample_extent", sample_extent(workload)},
          {"sample_distance", sample_distance(workload)},
          {"path_length", workload.path_length}};
}

Json numbers_json(const Workload& workload) {
  Json json{{"scene", validate::name_of_numbers(workload)},
            {"field", name(sim::Field::isotropic)},
            {"front_facing", workload.front_facing}};
  json.update(to_json(workload));
  return json;
}

Json origin_json(const validate::JobRequest& request, const std::string& scene, sim::Field field) {
  Json json{{"scene", scene}};
  if (request.disc_file) json["discs"] = *request.disc_file;
  if (request.ray_file)
    json["ray_file"] = *request.ray_file;
  else
    json["field"] = name(field);
  json["front_facing"] = request.front_facing;
  json["seed"] = request.seed;
  return json;
}

Json lights_json(const std::vector<sim::Light>& lights) {
  Json json = Json::array();
  for (const sim::Light& light : lights) json.push_back({{"kind", name(sim::kind_of(light))}, {"flux", light.flux}});
  return json;
}

Json to_json(const validate::Job& job, const validate::JobRequest& request) {
  Json json = origin_json(request, job.name, job.field);
  if (job.field == sim::Field::mixed && !request.ray_file)
    json["shares"] = {{"isotropic", request.shares.isotropic},
                      {"directional", request.shares.directional},
                      {"point", request.shares.point}};
  if (!job.lights.empty() && job.field == sim::Field::photons && !request.ray_file) {
    json["light"] = lights_json(job.lights);
    json["up"] = sim::name(job.up);
  }
  json.update(to_json(job.workload));
  return json;
}

void note_all(const CommonOptions& common, const validate::Job& job) {
  for (const std::string& notice : job.notices) note(common, notice);
  for (const std::string& warning : job.warnings) note(common, "warning: " + warning);
}

namespace {

/// "; lights: area, spot (up: y)"; empty if the rays are not from lights.
std::string lights_of(const validate::Job& job) {
  if (job.lights.empty() || job.field != sim::Field::photons || job.rays_from_file) return "";
  std::vector<std::string_view> kinds;
  for (const sim::Light& light : job.lights) kinds.push_back(name(sim::kind_of(light)));
  return fmt::format("; light{}: {} (up: {})", kinds.size() == 1 ? "" : "s", fmt::join(kinds, ", "), sim::name(job.up));
}

bool has_ends(const sim::Ray& ray) { return ray.length != sim::unbounded; }

/// What the rays are, whatever the effects are: "pieces of photon paths".
std::string_view rays_of(const validate::Job& job) {
  if (job.rays_from_file) return std::ranges::any_of(job.rays, has_ends) ? "segments from a file" : "lines from a file";
  if (job.field == sim::Field::mixed) return "of a mixed field: isotropic lines, parallel lines, segments from a point";
  return job.field == sim::Field::photons ? "pieces of photon paths" : "isotropic lines";
}

/// ", 40 123 photons"; empty if each ray is a photon of its own.
std::string photons_of(const validate::Job& job) {
  return job.numbered() ? fmt::format(", {} photons", spaced(static_cast<double>(job.independent_photons()))) : "";
}

/// ", mean length 0.30 of the scene's side", or that predictions neglect the ends; empty for lines.
std::string lengths_of(const validate::Job& job) {
  const bool end = job.rays_from_file ? std::ranges::any_of(job.rays, has_ends) : job.field == sim::Field::photons;
  if (!end) return "";
  if (job.workload.path_length > 0)
    return fmt::format(", mean length {:.2f} of the scene's side", job.workload.path_length / scene_side(job.workload));
  return ", predicted as if they were lines (effect finite paths: off)";
}

}  // namespace

std::string describe(const validate::Job& job) {
  const Workload& w = job.workload;
  const double x = sample_distance(w) / w.disc_radius;
  std::string text = fmt::format("scene     {}: ", shown_path(job.name));
  if (job.triangles > 0) text += fmt::format("{} triangles, ", spaced(static_cast<double>(job.triangles)));
  text += fmt::format("{} discs of radius d = {:.4g} ({:.3g} % of the scene), X = {:.2f}, D = {:.2f}\n",
                      spaced(w.samples), w.disc_radius, 100 * w.disc_radius / scene_side(w), x, w.dimension);
  return text + fmt::format("rays      {} {}{}{}{}\n", spaced(w.rays), rays_of(job), photons_of(job), lengths_of(job),
                            lights_of(job));
}

}  // namespace detp::cli
