#include "face_sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/search/hit_collector.hpp"
#include "detp/sim/search/problem.hpp"

namespace detp::sim {
namespace {

void add_areas(const Mesh& mesh, SurfaceParts& parts) {
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
    for (const std::uint32_t part : parts.parts_of(triangle))
      parts.areas[part] += glm::length(area_vector(mesh, triangle));
}

}  // namespace

glm::dvec3 area_vector(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return 0.5 * glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
}

SurfaceParts parts_by_triangle(const Mesh& mesh) {
  SurfaceParts parts{.areas = std::vector<double>(mesh.triangles.size())};
  add_areas(mesh, parts);
  return parts;
}

SurfaceParts parts_by_material(const Mesh& mesh) {
  const std::vector<Material>& all = mesh.materials.all;
  constexpr std::uint32_t unused = UINT32_MAX;
  std::vector<std::uint32_t> part_of(std::max<std::size_t>(1, all.size()), unused);
  const auto material_of = [&](std::uint32_t triangle) {
    return all.empty() ? std::size_t{0} : mesh.materials.number_of(triangle);
  };
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) part_of[material_of(triangle)] = 0;
  SurfaceParts parts;
  for (std::size_t material = 0; material < part_of.size(); ++material) {
    if (part_of[material] == unused) continue;
    part_of[material] = static_cast<std::uint32_t>(parts.names.size());
    parts.sets.push_back({part_of[material]});
    parts.names.push_back(all.empty() || all[material].name.empty() ? fmt::format("material {}", material)
                                                                    : all[material].name);
  }
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
    parts.set_of_triangle.push_back(part_of[material_of(triangle)]);
  parts.areas.resize(parts.names.size());
  add_areas(mesh, parts);
  return parts;
}

SurfaceParts parts_by_group(const Mesh& mesh) {
  SurfaceParts parts;
  if (mesh.groups.of_triangle.empty()) return parts;
  std::vector<bool> used(mesh.groups.names.size());
  for (const std::uint32_t set : mesh.groups.of_triangle)
    for (const std::uint32_t name : mesh.groups.sets[set]) used[name] = true;
  std::vector<std::uint32_t> part_of(used.size());
  for (std::size_t name = 0; name < used.size(); ++name)
    if (used[name]) {
      part_of[name] = static_cast<std::uint32_t>(parts.names.size());
      parts.names.push_back(mesh.groups.names[name]);
    }
  for (const std::vector<std::uint32_t>& set : mesh.groups.sets) {
    std::vector<std::uint32_t>& own = parts.sets.emplace_back();
    for (const std::uint32_t name : set)
      if (used[name]) own.push_back(part_of[name]);
  }
  parts.set_of_triangle = mesh.groups.of_triangle;
  parts.areas.resize(parts.names.size());
  add_areas(mesh, parts);
  return parts;
}

Outcome sums_of_parts(const PathRays& rays, const Mesh& mesh, const SurfaceParts& parts, bool front_facing,
                      const RunOptions& options) {
  if (rays.triangles.size() != rays.rays.size())
    throw std::invalid_argument(
        "light on faces needs photons that land on a scene's triangles: photon paths, or a ray file with its scene");
  const DefaultFloatingPoint mode;
  // Discs of the parts' areas; a part without area gets no light.
  std::vector<Disc> discs;
  for (const double area : parts.areas)
    discs.push_back({{0, 0, 0}, {0, 0, 1}, area > 0 ? std::sqrt(area / std::numbers::pi) : 1});
  const Problem problem = make_problem(rays, discs, false, options.threads, options.stop);
  Outcome outcome;
  HitCollector hits(problem, options, outcome);
  StopCheck check(options.stop, "adding up light on faces");
  std::uint32_t ray = 0;
  for (; ray < rays.rays.size() && !check.requested_after(1); ++ray) {
    const std::uint32_t triangle = rays.triangles[ray];
    if (triangle == no_triangle) continue;
    if (front_facing && !(glm::dot(area_vector(mesh, triangle), rays.rays[ray].direction) < 0)) continue;
    for (const std::uint32_t part : parts.parts_of(triangle)) hits.add_hit(ray, part);
  }
  hits.store_results(ray);
  return outcome;
}

}  // namespace detp::sim
