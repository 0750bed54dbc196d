#include "workload_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"

namespace detp::cli {
namespace {

std::string known_techniques() {
  std::string list;
  for (const Technique technique : all_techniques)
    list += fmt::format("{}{}", list.empty() ? "" : ", ", name(technique));
  return list;
}

std::string known_traversals() {
  std::string list;
  for (const Traversal traversal : all_traversals)
    list += fmt::format("{}{}", list.empty() ? "" : ", ", name(traversal));
  return list;
}

/// 100000 as "100 000".
std::string spaced(double count) {
  std::string digits = fmt::format("{:.0f}", count);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), " ");
  return digits;
}

}  // namespace

std::string_view name(sim::Field field) { return field == sim::Field::isotropic ? "isotropic" : "photons"; }

void WorkloadOptions::add_to(CLI::App& command, Values values) {
  using enum ValueLists::Kind;
  command.add_option("SCENE", request_.scene,
                     "a mesh (.obj, .ply) or @uniform, @tree, @tree-coarse, @courtyard, @cornell");
  command.add_option("--discs", request_.disc_file, "discs from a CSV or PLY file");
  command.add_option("--ray-file", request_.ray_file, "rays from a CSV or PLY file");
  lists.add(command, "--rays", values, request_.rays, "how many rays");
  lists.add(command, "--samples", values, request_.samples, "how many samples; default: the scene's vertices");
  lists.add(
      command, "--disc-radius", values, numbers,
      [this](const std::string& text) { request_.disc_radius = validate::parse_length(text); },
      "d: a length, or a percentage of the scene's longest side");
  lists.add(command, "--sphere-radius", values, request_.sphere_radius, "r0, of a workload in numbers");
  lists.add(command, "--scene-side", values, request_.scene_side, "s, of a workload in numbers; r0 = s sqrt(3)/2 + d");
  lists.add(command, "--dimension", values, request_.dimension, "D of the samples: 3 fill a volume, 2 lie on surfaces");
  lists.add(command, "--sample-extent", values, request_.sample_extent, "volume or area that the samples fill");
  lists.add(
      command, "--field", values, words,
      [this](const std::string& text) {
        const bool lines = one_of("--field", text, {"isotropic", "photons"}) == "isotropic";
        request_.field = lines ? sim::Field::isotropic : sim::Field::photons;
      },
      "isotropic (lines) or photons (paths from the scene's light)");
  command.add_flag("--front-facing", request_.front_facing, "count only rays that arrive at a disc's front");
}

validate::JobRequest WorkloadOptions::request(const CommonOptions& common) const {
  validate::JobRequest request = request_;
  request.seed = common.seed;
  if (!request.numbers_alone() && (request.sphere_radius || request.scene_side))
    throw std::invalid_argument(
        "--sphere-radius and --scene-side describe a workload in numbers; a scene has its own size");
  return request;
}

void CandidateOptions::add_to(CLI::App& command, Values values, SphereStop default_stop) {
  using enum ValueLists::Kind;
  lists.add(
      command, "--technique", values, words, [this](const std::string& text) { technique = text; }, known_techniques());
  lists.add(command, "--ratio", values, ratio, "Q of a sphere cache, between 0 and 1");
  lists.add(
      command, "--spheres", values, numbers, [this](const std::string& text) { set_spheres(text); },
      fmt::format("k of a sphere cache: its innermost sphere, as a number; max: the form's own; best: the fastest by "
                  "the model; default: {}",
                  default_stop == SphereStop::max ? "max" : "best"));
  lists.add_word(command, "--order", values, order, {"lebesgue", "hilbert", "none"}, "lebesgue, hilbert or none");
  lists.add(command, "--depth", values, depth, "levels of an octree, of a BSP tree at most, or of cells with spheres");
  lists.add(
      command, "--traversal", values, words, [this](const std::string& text) { traversal = text; },
      "how rays go through an octree: " + known_traversals());
  lists.add(command, "--cells", values, cells, "cells of a grid along its longest side");
  lists.add(command, "--fan-out", values, fan_out, "children of a sphere tree's nodes, at least 2");
  lists.add(command, "--leaf", values, leaf, "most samples in a leaf of a sphere tree or BSP tree");
  lists.add_word(command, "--quality", values, quality, {"low", "medium"}, "of building a bvh: low or medium");
  lists.add(command, "--nearest", values, nearest, "photons that a photon-map looks for, at least 3");
  lists.add_word(command, "--bounds", values, bounds, {"spheres", "boxes"},
                 "what bounds a sphere tree's nodes: spheres or boxes");
}

void CandidateOptions::set_spheres(const std::string& text) {
  spheres.reset();
  stop.reset();
  if (text == "max")
    stop = SphereStop::max;
  else if (text == "best")
    stop = SphereStop::best;
  else
    spheres = parse_whole("--spheres", text);
}

Technique CandidateOptions::technique_or(Technique otherwise) const {
  if (!technique) return otherwise;
  const auto found = technique_named(*technique);
  if (!found)
    throw std::invalid_argument(
        fmt::format("there is no technique {}; there are {}", detp::quoted(*technique), known_techniques()));
  return *found;
}

SampleOrder CandidateOptions::sample_order() const { return *order_named(order); }

BvhParameters CandidateOptions::bvh() const {
  return quality ? BvhParameters{*quality_named(*quality)} : BvhParameters{};
}

PhotonMapParameters CandidateOptions::photon_map() const {
  return nearest ? PhotonMapParameters{*nearest} : PhotonMapParameters{};
}

model::TreeWish CandidateOptions::tree_wish() const {
  return {bounds ? bounds_named(*bounds) : std::nullopt, fan_out, leaf};
}

Traversal CandidateOptions::chosen_traversal() const {
  if (!traversal) return Traversal::top_down;
  const auto found = traversal_named(*traversal);
  if (!found)
    throw std::invalid_argument(
        fmt::format("there is no traversal {}; there are {}", detp::quoted(*traversal), known_traversals()));
  return *found;
}

void CandidateOptions::refuse_foreign(Technique chosen) const {
  const bool cache = chosen == Technique::sphere_cache || chosen == Technique::sphere_cache_published;
  const auto refuse = [&](const char* option) {
    throw std::invalid_argument(fmt::format("{} is no parameter of {}", option, detp::name(chosen)));
  };
  if (ratio && !cache) refuse("--ratio");
  if ((spheres || stop) && !cache) refuse("--spheres");
  if (order != "lebesgue" && !cache) refuse("--order");
  const bool deep = chosen == Technique::octree || chosen == Technique::cell_spheres || chosen == Technique::bsp;
  if (depth && !deep) refuse("--depth");
  if (traversal && chosen != Technique::octree) refuse("--traversal");
  if (cells && chosen != Technique::grid) refuse("--cells");
  if (fan_out && chosen != Technique::sphere_tree) refuse("--fan-out");
  if (leaf && chosen != Technique::sphere_tree && chosen != Technique::bsp) refuse("--leaf");
  if (quality && chosen != Technique::bvh) refuse("--quality");
  if (nearest && chosen != Technique::photon_map) refuse("--nearest");
  if (bounds && chosen != Technique::sphere_tree) refuse("--bounds");
}

Json to_json(const Parameters& parameters) {
  Json json = Json::object();
  if (const auto* cache = std::get_if<SphereCacheParameters>(&parameters))
    json = {{"ratio", cache->ratio}, {"spheres", cache->spheres}, {"order", detp::name(cache->order)}};
  if (const auto* cells = std::get_if<CellSpheresParameters>(&parameters)) json = {{"depth", cells->depth}};
  if (const auto* tree = std::get_if<SphereTreeParameters>(&parameters))
    json = {{"fan_out", tree->fan_out}, {"leaf", tree->leaf}, {"bounds", detp::name(tree->bounds)}};
  if (const auto* octree = std::get_if<OctreeParameters>(&parameters))
    json = {{"depth", octree->depth}, {"traversal", detp::name(octree->traversal)}};
  if (const auto* grid = std::get_if<GridParameters>(&parameters)) json = {{"cells", grid->cells}};
  if (const auto* bvh = std::get_if<BvhParameters>(&parameters)) json = {{"quality", detp::name(bvh->quality)}};
  if (const auto* map = std::get_if<PhotonMapParameters>(&parameters)) json = {{"nearest", map->nearest}};
  if (const auto* bsp = std::get_if<BspParameters>(&parameters)) json = {{"depth", bsp->depth}, {"leaf", bsp->leaf}};
  return json;
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

Json to_json(const validate::Job& job, const validate::JobRequest& request) {
  Json json{{"scene", job.name}};
  if (request.disc_file) json["discs"] = *request.disc_file;
  if (request.ray_file)
    json["ray_file"] = *request.ray_file;
  else
    json["field"] = name(job.field);
  json["front_facing"] = job.front_facing;
  json["seed"] = request.seed;
  json.update(to_json(job.workload));
  return json;
}

Json effects_json(const Workload& workload) {
  const double chord = 4 * workload.sphere_radius / 3;
  return Json::array({{{"name", "finite paths"},
                       {"on", workload.path_length > 0},
                       {"evidence", workload.path_length > 0 ? workload.path_length / chord : 1.0},
                       {"meaning", "mean length of the rays over the mean chord of S0"}},
                      {{"name", "surface samples"},
                       {"on", workload.dimension < 2.9},
                       {"evidence", workload.dimension},
                       {"meaning", "dimension of the samples by box counting"}}});
}

Json effect_cells(const Json& effects) {
  Json cells = Json::object();
  for (const Json& effect : effects) {
    std::string name = effect["name"];
    std::replace(name.begin(), name.end(), ' ', '_');
    cells[name] = effect["on"];
    cells[name + "_evidence"] = effect["evidence"];
  }
  return cells;
}

void note_all(const CommonOptions& common, const validate::Job& job) {
  for (const std::string& notice : job.notices) note(common, notice);
  for (const std::string& warning : job.warnings) note(common, "warning: " + warning);
}

std::string describe(const validate::Job& job) {
  const Workload& w = job.workload;
  const double x = sample_distance(w) / w.disc_radius;
  std::string text = fmt::format("scene     {}: ", shown_path(job.name));
  if (job.triangles > 0) text += fmt::format("{} triangles, ", spaced(static_cast<double>(job.triangles)));
  text += fmt::format("{} discs of radius {:.4g} ({:.3g} % of the scene), X = {:.2f}, D = {:.2f}\n", spaced(w.samples),
                      w.disc_radius, 100 * w.disc_radius / scene_side(w), x, w.dimension);
  text += fmt::format("rays      {} ", spaced(w.rays));
  if (w.path_length > 0)
    text += fmt::format("photon paths or segments, mean length inside the scene {:.2f} of its side\n",
                        w.path_length / scene_side(w));
  else
    text += "isotropic lines\n";
  return text;
}

}  // namespace detp::cli
