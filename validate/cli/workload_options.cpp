#include "workload_options.hpp"

#include <fmt/format.h>

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

void WorkloadOptions::add_to(CLI::App& command) {
  command.add_option("SCENE", request_.scene,
                     "a mesh (.obj, .ply) or @uniform, @tree, @tree-coarse, @courtyard, @cornell");
  command.add_option("--discs", request_.disc_file, "discs from a CSV or PLY file");
  command.add_option("--ray-file", request_.ray_file, "rays from a CSV or PLY file");
  command.add_option("--rays", request_.rays, "how many rays");
  command.add_option("--samples", request_.samples, "how many samples; default: the scene's vertices");
  command.add_option("--disc-radius", disc_radius_, "d: a length, or a percentage of the scene's longest side");
  command.add_option("--sphere-radius", request_.sphere_radius, "r0, of a workload in numbers");
  command.add_option("--scene-side", request_.scene_side, "s, of a workload in numbers; r0 = s sqrt(3)/2 + d");
  command.add_option("--dimension", request_.dimension, "D of the samples: 3 fill a volume, 2 lie on surfaces");
  command.add_option("--sample-extent", request_.sample_extent, "volume or area that the samples fill");
  command.add_option("--field", field_, "isotropic (lines) or photons (paths from the scene's light)")
      ->check(CLI::IsMember({"isotropic", "photons"}));
  command.add_flag("--front-facing", request_.front_facing, "count only rays that arrive at a disc's front");
}

validate::JobRequest WorkloadOptions::request(const CommonOptions& common) const {
  validate::JobRequest request = request_;
  request.seed = common.seed;
  if (!disc_radius_.empty()) request.disc_radius = validate::parse_length(disc_radius_);
  if (field_ == "isotropic") request.field = sim::Field::isotropic;
  if (field_ == "photons") request.field = sim::Field::photons;
  if (!request.numbers_alone() && (request.sphere_radius || request.scene_side))
    throw std::invalid_argument(
        "--sphere-radius and --scene-side describe a workload in numbers; a scene has its own size");
  return request;
}

void CandidateOptions::add_to(CLI::App& command) {
  command.add_option("--technique", technique, known_techniques());
  command.add_option("--ratio", ratio, "Q of a sphere cache, between 0 and 1");
  command.add_option("--spheres", spheres, "k of a sphere cache, its innermost sphere");
  command.add_option("--order", order, "lebesgue, hilbert or none")
      ->check(CLI::IsMember({"lebesgue", "hilbert", "none"}));
  command.add_option("--depth", depth, "levels of an octree, of a BSP tree at most, or of cells with spheres");
  command.add_option("--traversal", traversal, "how rays go through an octree: " + known_traversals());
  command.add_option("--cells", cells, "cells of a grid along its longest side");
  command.add_option("--fan-out", fan_out, "children of a sphere tree's nodes, at least 2");
  command.add_option("--leaf", leaf, "most samples in a leaf of a sphere tree or BSP tree");
  command.add_option("--quality", quality, "of building a bvh: low or medium")->check(CLI::IsMember({"low", "medium"}));
  command.add_option("--nearest", nearest, "photons that a photon-map looks for, at least 3");
  command.add_option("--bounds", bounds, "what bounds a sphere tree's nodes: spheres or boxes")
      ->check(CLI::IsMember({"spheres", "boxes"}));
}

Technique CandidateOptions::technique_or(Technique otherwise) const {
  if (!technique) return otherwise;
  const auto found = technique_named(*technique);
  if (!found)
    throw std::invalid_argument(
        fmt::format("there is no technique '{}'; there are {}", *technique, known_techniques()));
  return *found;
}

SampleOrder CandidateOptions::sample_order() const { return *order_named(order); }

BvhParameters CandidateOptions::bvh() const {
  return quality ? BvhParameters{*quality_named(*quality)} : BvhParameters{};
}

PhotonMapParameters CandidateOptions::photon_map() const {
  return nearest ? PhotonMapParameters{*nearest} : PhotonMapParameters{};
}

Traversal CandidateOptions::chosen_traversal() const {
  if (!traversal) return Traversal::top_down;
  const auto found = traversal_named(*traversal);
  if (!found)
    throw std::invalid_argument(
        fmt::format("there is no traversal '{}'; there are {}", *traversal, known_traversals()));
  return *found;
}

void CandidateOptions::refuse_foreign(Technique chosen) const {
  const bool cache = chosen == Technique::sphere_cache || chosen == Technique::sphere_cache_published;
  const auto refuse = [&](const char* option) {
    throw std::invalid_argument(fmt::format("{} is no parameter of {}", option, detp::name(chosen)));
  };
  if (ratio && !cache) refuse("--ratio");
  if (spheres && !cache) refuse("--spheres");
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
  Json json{{"scene", validate::name_of_numbers(workload)}, {"field", name(sim::Field::isotropic)}};
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
