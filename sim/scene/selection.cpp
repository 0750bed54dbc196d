#include "selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/closest_point.hpp"
#include "near_triangles.hpp"

namespace detp::sim {
namespace {

constexpr const char* finding = "finding the samples on named faces";
constexpr double least_cosine_to_face = 0.5;
constexpr double on_face = 1e-6;  // of the diagonal
constexpr double as_near = 1e-9;  // of the diagonal

/// `kind` is "material" or "group".
[[noreturn]] void fail_unknown(std::string_view kind, const std::string& name,
                               const std::set<std::string_view>& known) {
  constexpr std::size_t most_shown = 10;
  if (known.empty())
    throw std::invalid_argument(fmt::format("there is no {0} {1}: the mesh has no {0}s", kind, quoted(name)));
  const std::vector<std::string_view> all(known.begin(), known.end());
  std::string shown;
  for (std::size_t i = 0; i < std::min(all.size(), most_shown); ++i) shown += (i == 0 ? "" : ", ") + shortened(all[i]);
  if (all.size() > most_shown) shown += fmt::format(" and {} more", all.size() - most_shown);
  throw std::invalid_argument(
      fmt::format("there is no {0} {1}; known {0}s are {2}{3}", kind, quoted(name), shown, did_you_mean(name, all)));
}

/// For each of `all`, whether it is one of the names. Throws for a name that is none of them.
std::vector<bool> is_one_of(const std::vector<std::string>& names, const std::vector<std::string_view>& all,
                            std::string_view kind) {
  std::set<std::string_view> known(all.begin(), all.end());
  known.erase("");
  for (const std::string& name : names)
    if (!known.contains(name)) fail_unknown(kind, name, known);
  const std::set<std::string_view> wanted(names.begin(), names.end());
  std::vector<bool> chosen;
  for (const std::string_view one : all) chosen.push_back(wanted.contains(one));
  return chosen;
}

std::vector<bool> materials_named(const Materials& materials, const std::vector<std::string>& names) {
  std::vector<std::string_view> all;
  for (const Material& material : materials.all) all.emplace_back(material.name);
  return is_one_of(names, all, "material");
}

/// For each set of groups, whether one of them is named.
std::vector<bool> sets_named(const Groups& groups, const std::vector<std::string>& names) {
  const std::vector<bool> chosen = is_one_of(names, {groups.names.begin(), groups.names.end()}, "group");
  std::vector<bool> sets;
  for (const auto& set : groups.sets)
    sets.push_back(std::ranges::any_of(set, [&](std::uint32_t group) { return chosen[group]; }));
  return sets;
}

using VertexKey = std::array<double, 6>;

VertexKey key_of_vertex(const glm::dvec3& position, const glm::dvec3& normal) {
  const auto rounded = [](double value) { return std::round(value * 1e6); };
  return {position.x, position.y, position.z, rounded(normal.x), rounded(normal.y), rounded(normal.z)};
}

/// The vertices of a mesh with normals.
class NamedVertices {
 public:
  NamedVertices(const Mesh& mesh, const std::vector<bool>& named, StopCheck& check) {
    std::vector<bool> is_other(mesh.positions.size(), true);
    for_each_checked(0, named.size(), check, [&](std::size_t i) {
      if (!named[i]) return;
      for (const std::uint32_t corner : mesh.triangles[i]) is_other[corner] = false;
    });
    vertices_.reserve(mesh.normals.size());
    for_each_checked(0, mesh.normals.size(), check, [&](std::size_t i) {
      vertices_.emplace_back(key_of_vertex(mesh.positions[i], mesh.normals[i]), is_other[i]);
    });
    std::sort(vertices_.begin(), vertices_.end(), [&](const auto& a, const auto& b) {
      check.after(1);
      return a < b;
    });
  }

  enum class Found { nothing, other, named };

  /// The vertex at which the sample is.
  [[nodiscard]] Found at(const Sample& sample) const {
    const VertexKey key = key_of_vertex(sample.position, sample.normal);
    const auto found = std::ranges::lower_bound(vertices_, std::pair{key, false});
    if (found == vertices_.end() || found->first != key) return Found::nothing;
    return found->second ? Found::other : Found::named;
  }

 private:
  std::vector<std::pair<VertexKey, bool>> vertices_;  ///< sorted; whether no named triangle has the vertex
};

/// Whether the sample, which is at no vertex, lies on a named triangle.
bool lies_on_named(const Sample& sample, const NearTriangles& near, const std::vector<bool>& named, double diagonal,
                   StopCheck& check) {
  double least = unbounded;
  double least_of_named = unbounded;
  near.visit(sample.position, on_face * diagonal, [&](std::uint32_t triangle) {
    check.add(1);
    const Facet& facet = near.facet(triangle);
    if (glm::dot(facet.normal, sample.normal) < least_cosine_to_face) return;
    const glm::dvec3 corner = facet.corner - sample.position;
    const double distance = distance_to_triangle(corner, corner + facet.first, corner + facet.second);
    least = std::min(least, distance);
    if (named[triangle]) least_of_named = std::min(least_of_named, distance);
  });
  return least_of_named <= std::min(on_face * diagonal, least + as_near * diagonal);
}

}  // namespace

std::vector<bool> triangles_named(const Mesh& mesh, const FaceNames& names) {
  std::vector<bool> named(mesh.triangles.size(), true);
  const auto keep = [&](const auto& is_kept) {
    for (std::size_t i = 0; i < named.size(); ++i) named[i] = named[i] && is_kept(i);
  };
  if (!names.materials.empty()) {
    check(mesh.materials, named.size());
    const std::vector<bool> chosen = materials_named(mesh.materials, names.materials);
    keep([&](std::size_t i) {
      return chosen[mesh.materials.number_of(i)] || (mesh.materials.has_back(i) && chosen[mesh.materials.of_back[i]]);
    });
  }
  if (!names.groups.empty()) {
    const std::vector<bool> chosen = sets_named(mesh.groups, names.groups);
    if (mesh.groups.of_triangle.size() != named.size())
      throw std::invalid_argument(fmt::format("each triangle needs a set of groups ({} for {} triangles)",
                                              mesh.groups.of_triangle.size(), named.size()));
    keep([&](std::size_t i) { return chosen[mesh.groups.of_triangle[i]]; });
  }
  return named;
}

std::vector<std::size_t> samples_on(const Mesh& mesh, std::span<const Sample> samples, const std::vector<bool>& chosen,
                                    const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  using Found = NamedVertices::Found;
  StopCheck check(stop, finding);
  std::vector<Found> found;
  found.reserve(samples.size());
  {
    const NamedVertices vertices(mesh, chosen, check);
    for_each_checked(samples, check, [&](const Sample& sample) { found.push_back(vertices.at(sample)); });
  }
  if (std::ranges::find(found, Found::nothing) != found.end()) {
    const NearTriangles near(mesh, stop);
    const double diagonal = glm::length(used_box(mesh).size());
    sim::parallel_for(ParallelRange(0, samples.size()), [&](const ParallelRange& part) {
      StopCheck own(stop, finding);
      own.now();
      for (std::size_t i = part.begin(); i != part.end(); ++i) {
        own.after(1);
        if (found[i] == Found::nothing && lies_on_named(samples[i], near, chosen, diagonal, own))
          found[i] = Found::named;
      }
    });
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i] == Found::named) indices.push_back(i);
  return indices;
}

std::vector<std::size_t> samples_named(const Mesh& mesh, std::span<const Sample> samples, const FaceNames& names,
                                       const std::stop_token& stop) {
  const std::vector<bool> named = triangles_named(mesh, names);
  std::vector<std::size_t> indices = samples_on(mesh, samples, named, stop);
  if (indices.empty())
    throw std::invalid_argument(
        fmt::format("no sample lies on the named faces, which are {} triangles{}", std::ranges::count(named, true),
                    mesh.coincident > 0 ? "; of faces in the same place, the names of the first one hold" : ""));
  return indices;
}

}  // namespace detp::sim
