#include "workload_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/open/open_scene.hpp"

namespace detp::cli {
namespace {

/// The effects that --effects switches.
std::string switched_effects() {
  std::vector<std::string> names;
  for (const sim::Effect* effect : sim::all_effects)
    if (!effect->is_input) names.push_back(sim::option_name(*effect));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// "isotropic", "photons", "mixed" or "mixed:0.5:0.25:0.25". Throws std::invalid_argument for other text, and unless shares
/// add up to 1.
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

void WorkloadOptions::add_to(CLI::App& command, Values values, std::optional<Values> axes) {
  using enum ValueLists::Kind;
  command.add_option("SCENE", request_.scene,
                     fmt::format("a mesh ({}), or {} (one of many, SEED a whole number)", sim::mesh_suffixes(),
                                 sim::built_in_scenes()));
  command.add_option("--discs", request_.disc_file,
                     "discs from a CSV, PLY, NPY or NPZ file; default: one at each of the scene's samples");
  command.add_option("--ray-file", request_.ray_file,
                     "rays from a CSV, PLY, NPY, NPZ or MCPL file; default: made, as --field says");
  command.add_flag("--landed", request_.landed,
                   "the ray file is a photon map: origins are where photons landed in the scene, directions those of "
                   "their flight; the pieces of their paths are found");
  lists.add(
      command, "--columns", Values::one, words,
      [this](const std::string& text) { request_.columns = sim::parse_column_names(text); },
      "what the ray file and the disc file call their columns, as ox=px,oy=py,oz=pz,dx=-wx (a minus turns the sign), "
      "or "
      "the columns' numbers in files without headings, as ox=1; default: by the names that follow");
  lists.add(
      command, "--bands", Values::one, words,
      [this](const std::string& text) {
        request_.rgb = text == "rgb";
        if (!request_.rgb) request_.bands = sim::parse_bands(text);
      },
      "powers in bands: rgb (photons in the colours of the scene's materials), or names and the columns of the ray "
      "file "
      "that have them, as r=red,g=green,b=blue; default: one power, or columns power_r, power_g and so on");
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
  lists.add(
      command, "--crease", Values::one, numbers,
      [this](const std::string& text) { request_.crease = parse_crease(text); },
      fmt::format("angle between faces, in degrees, from which their edge is sharp and a vertex has a sample for each "
                  "face, in meshes without normals; default: {}",
                  sim::default_crease));
  command.add_flag("--front-facing", request_.front_facing, "count only rays that arrive at a disc's front");
  command.add_flag("--second-intersection", request_.second_intersection,
                   "photon paths go on to the second surface that they meet, as in the paper; default: as far as the "
                   "effect concave surfaces says");
  lists.add(
      command, "--effects", Values::one, words,
      [this](const std::string& text) { request_.effects = sim::EffectSelection(text); },
      fmt::format(
          "deviations from uniform lines and samples that are taken into account: auto (where the evidence calls "
          "for them), none, all, or a list of {}; default: auto",
          switched_effects()));
}

void add_face_names(CLI::App& command, sim::FaceNames& names) {
  command
      .add_option("--material", names.materials,
                  "errors are those of the samples on faces with these materials, a list; default: of all samples")
      ->delimiter(',');
  command
      .add_option("--group", names.groups, "the same of faces in these groups or objects of an OBJ file; default: all")
      ->delimiter(',');
}

double parse_crease(const std::string& text) {
  const double crease = parse_number("--crease", text);
  if (!(crease >= 0 && crease <= 180))
    throw std::invalid_argument(fmt::format("--crease must be from 0 to 180 degrees (got {})", text));
  return crease;
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

}  // namespace detp::cli
