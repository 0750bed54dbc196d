#include "vertices.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

#include "detp/sim/geometry/directions.hpp"

namespace detp::sim {
namespace {

/// If the cross product of two edges is below this share of the product of their lengths, it is rounding error: the
/// triangle has no area.
constexpr double least_area = 8 * std::numeric_limits<double>::epsilon();
/// If a sum of normals is shorter than this share of their weights, it is a residue of cancellation.
constexpr double least_sum = 1e-12;
constexpr double same_normal = 1e-6;
constexpr glm::dvec3 none{0.0};

using Corners = std::array<glm::dvec3, 3>;

/// Scales the largest used coordinate to about 1.
Scaling scaling_of(const Mesh& mesh) {
  double largest = 0;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(mesh.positions[corner][axis]));
  return Scaling::to_one(largest);
}

/// Twice the triangle's area times its unit normal; zero if it has no area. Computed at the corner between the two
/// shorter edges, where the rounding error is least.
glm::dvec3 area_vector(const Corners& corners) {
  const std::array edges{corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (glm::dot(edges[i], edges[i]) > glm::dot(edges[longest], edges[longest])) longest = i;
  const glm::dvec3& first = edges[(longest + 1) % 3];
  const glm::dvec3& second = edges[(longest + 2) % 3];
  const glm::dvec3 vector = glm::cross(first, second);
  return glm::length(vector) > least_area * glm::length(first) * glm::length(second) ? vector : glm::dvec3{0.0};
}

double angle_at(const Corners& corners, std::size_t corner) {
  const glm::dvec3 first = corners[(corner + 1) % 3] - corners[corner];
  const glm::dvec3 second = corners[(corner + 2) % 3] - corners[corner];
  return std::atan2(glm::length(glm::cross(first, second)), glm::dot(first, second));
}

std::uint64_t hash_of_numbers(const std::array<std::uint64_t, 3>& numbers) {
  std::uint64_t hash = 0;
  for (const std::uint64_t number : numbers) {
    hash = (hash ^ number) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32;
  }
  return hash;
}

std::uint64_t hash_of_position(const glm::dvec3& position) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value); };
  return hash_of_numbers({bits(position.x), bits(position.y), bits(position.z)});
}

/// Normals that are equal have equal keys.
std::array<std::int32_t, 3> key_of(const glm::dvec3& normal) {
  std::array<std::int32_t, 3> key{};
  for (int axis = 0; axis < 3; ++axis)
    key[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(std::lround(normal[axis] / same_normal));
  return key;
}

/// A corner of a triangle, at the place under way.
struct PlaceCorner {
  std::uint32_t number;  ///< 3 · triangle + corner
  std::uint32_t vertex;
  std::uint32_t group;  ///< place in the list of the first corner of its group
  glm::dvec3 given;     ///< the mesh's normal; 0: none
  bool has_group;       ///< no normal is given, and the triangle has an area
};

/// An edge from the place to another one.
struct EdgeOfPlace {
  std::uint32_t to;
  std::uint32_t corner;  ///< place in the list of corners
};

struct Vertex {
  std::uint32_t place;        ///< an old vertex at its position
  std::uint32_t file_vertex;  ///< least of its corners
  std::uint32_t first_corner;
  glm::dvec3 normal;
  std::array<std::int32_t, 3> key;  ///< of the normal
};

class VertexMaker {
 public:
  VertexMaker(Mesh& mesh, double crease, const std::stop_token& stop)
      : mesh_(mesh),
        check_(stop, "taking samples at the vertices"),
        least_cosine_(crease >= 180 ? -2 : std::cos(crease * std::numbers::pi / 180)),
        scaled_(scaling_of(mesh)) {}

  void make() {
    first_ = first_of_place(mesh_.positions, check_);
    find_normals();
    list_corners();
    vertex_of_corner_.resize(3 * mesh_.triangles.size());
    for (std::size_t place = 0; place + 1 < starts_.size(); ++place)
      if (starts_[place] < starts_[place + 1]) make_vertices(place);
    write();
  }

 private:
  [[nodiscard]] Corners corners_of(std::size_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return {scaled_(mesh_.positions[a]), scaled_(mesh_.positions[b]), scaled_(mesh_.positions[c])};
  }

  [[nodiscard]] std::uint32_t file_vertex(std::uint32_t vertex) const {
    return mesh_.file_vertices.empty() ? vertex : mesh_.file_vertices[vertex];
  }

  void find_normals() {
    normals_.reserve(mesh_.triangles.size());
    areas_.reserve(mesh_.triangles.size());
    for_each_checked(0, mesh_.triangles.size(), check_, [&](std::size_t triangle) {
      const glm::dvec3 vector = area_vector(corners_of(triangle));
      areas_.push_back(glm::length(vector));
      normals_.push_back(unit_or_zero(vector));
    });
  }

  /// The corners at each place, in rising order.
  void list_corners() {
    starts_.resize(mesh_.positions.size() + 1);
    for (const auto& triangle : mesh_.triangles)
      for (const std::uint32_t corner : triangle) ++starts_[first_[corner] + 1];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    corners_.resize(starts_.back());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for_each_checked(0, mesh_.triangles.size(), check_, [&](std::size_t triangle) {
      for (std::size_t i = 0; i < 3; ++i)
        corners_[next[first_[mesh_.triangles[triangle][i]]]++] = static_cast<std::uint32_t>(3 * triangle + i);
    });
  }

  void make_vertices(std::size_t place) {
    here_.clear();
    const std::size_t first_vertex = vertices_.size();
    for (std::uint32_t i = starts_[place]; i < starts_[place + 1]; ++i) {
      const std::uint32_t vertex = mesh_.triangles[corners_[i] / 3][corners_[i] % 3];
      const glm::dvec3 given = normal_given(vertex);
      here_.push_back({corners_[i], vertex, static_cast<std::uint32_t>(here_.size()), given,
                       given == none && normals_[corners_[i] / 3] != none});
    }
    check_.after(here_.size());
    join_over_edges();
    for (const PlaceCorner& corner : here_)
      if (corner.given != none)
        add_corner(corner, corner.given, first_vertex);
      else if (corner.has_group)
        add_corner(corner, normal_of_group(corner), first_vertex);
    for (const PlaceCorner& corner : here_)  // of triangles without area: they take what is there
      if (corner.given == none && !corner.has_group)
        add_corner(corner, vertices_.size() > first_vertex ? vertices_[first_vertex].normal : none, first_vertex);
  }

  [[nodiscard]] glm::dvec3 normal_given(std::uint32_t vertex) const {
    return mesh_.normals.empty() ? none : unit_or_zero(mesh_.normals[vertex]);
  }

  std::uint32_t root(std::uint32_t corner) {
    while (here_[corner].group != corner) corner = here_[corner].group = here_[here_[corner].group].group;
    return corner;
  }

  void join_over_edges() {
    edges_.clear();
    sums_.assign(here_.size(), glm::dvec3{0.0});
    for (std::uint32_t i = 0; i < here_.size(); ++i) {
      if (!here_[i].has_group) continue;
      const auto& triangle = mesh_.triangles[here_[i].number / 3];
      for (const std::uint32_t step : {1U, 2U}) edges_.push_back({first_[triangle[(here_[i].number + step) % 3]], i});
    }
    std::ranges::sort(edges_, [](const EdgeOfPlace& a, const EdgeOfPlace& b) {
      return a.to != b.to ? a.to < b.to : a.corner < b.corner;
    });
    for (std::size_t i = 0; i < edges_.size(); ++i)
      for (std::size_t j = i + 1; j < edges_.size() && edges_[j].to == edges_[i].to; ++j) {
        check_.after(1);
        join(edges_[i].corner, edges_[j].corner);
      }
    weigh();
  }

  void join(std::uint32_t one, std::uint32_t other) {
    const std::uint32_t a = root(one);
    const std::uint32_t b = root(other);
    if (a != b && glm::dot(normals_[here_[one].number / 3], normals_[here_[other].number / 3]) > least_cosine_)
      here_[std::max(a, b)].group = std::min(a, b);
  }

  /// Adds up the normals of each group at its first corner.
  void weigh() {
    for (std::uint32_t i = 0; i < here_.size(); ++i) {
      const std::uint32_t triangle = here_[i].number / 3;
      if (here_[i].has_group)
        sums_[root(i)] += angle_at(corners_of(triangle), here_[i].number % 3) * normals_[triangle];
    }
  }

  [[nodiscard]] glm::dvec3 normal_of_group(const PlaceCorner& corner) {
    const std::uint32_t group = root(static_cast<std::uint32_t>(&corner - here_.data()));
    if (glm::length(sums_[group]) > least_sum) return unit_or_zero(sums_[group]);
    std::uint32_t largest = group;
    for (std::uint32_t i = 0; i < here_.size(); ++i)
      if (here_[i].has_group && root(i) == group && areas_[here_[i].number / 3] > areas_[here_[largest].number / 3])
        largest = i;
    return normals_[here_[largest].number / 3];
  }

  /// Gives the corner the vertex with this normal, among those of the place.
  void add_corner(const PlaceCorner& corner, const glm::dvec3& normal, std::size_t first_vertex) {
    const auto key = key_of(normal);
    std::size_t vertex = first_vertex;
    while (vertex < vertices_.size() && vertices_[vertex].key != key) ++vertex;
    check_.after(vertex - first_vertex);
    if (vertex == vertices_.size())
      vertices_.push_back({corner.vertex, file_vertex(corner.vertex), corner.number, normal, key});
    vertices_[vertex].file_vertex = std::min(vertices_[vertex].file_vertex, file_vertex(corner.vertex));
    vertex_of_corner_[corner.number] = static_cast<std::uint32_t>(vertex);
  }

  void write() {
    std::vector<std::uint32_t> order(vertices_.size());
    std::iota(order.begin(), order.end(), 0);
    const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
      check_.after(1);
      const Vertex& one = vertices_[a];
      const Vertex& other = vertices_[b];
      return one.file_vertex != other.file_vertex ? one.file_vertex < other.file_vertex
                                                  : one.first_corner < other.first_corner;
    };
    if (!std::ranges::is_sorted(order, is_before)) std::ranges::sort(order, is_before);
    std::vector<std::uint32_t> number(vertices_.size());
    std::vector<glm::dvec3> positions;
    positions.reserve(order.size());
    mesh_.normals.clear();
    mesh_.normals.reserve(order.size());
    mesh_.file_vertices.clear();
    for_each_checked(std::span(order), check_, [&](std::uint32_t vertex) {
      number[vertex] = static_cast<std::uint32_t>(positions.size());
      positions.push_back(mesh_.positions[vertices_[vertex].place]);
      mesh_.normals.push_back(vertices_[vertex].normal);
      mesh_.file_vertices.push_back(vertices_[vertex].file_vertex);
    });
    mesh_.positions = std::move(positions);
    for_each_checked(0, mesh_.triangles.size(), check_, [&](std::size_t triangle) {
      for (std::size_t i = 0; i < 3; ++i) mesh_.triangles[triangle][i] = number[vertex_of_corner_[3 * triangle + i]];
    });
  }

  Mesh& mesh_;
  StopCheck check_;
  double least_cosine_;
  Scaling scaled_;
  std::vector<std::uint32_t> first_;  ///< of the place of each old vertex
  std::vector<glm::dvec3> normals_;   ///< of triangles
  std::vector<double> areas_;         ///< of triangles, twice
  std::vector<std::uint32_t> starts_;
  std::vector<std::uint32_t> corners_;
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> vertex_of_corner_;
  std::vector<PlaceCorner> here_;
  std::vector<EdgeOfPlace> edges_;
  std::vector<glm::dvec3> sums_;
};

void note_dropped(Notices& notices, std::size_t count, const std::string& kind, const std::string& why = "") {
  if (count > 0)
    notices.push_back(std::to_string(count) + kind + (count == 1 ? " vertex" : " vertices") + " dropped" + why);
}

}  // namespace

void note_unreferenced(const Mesh& mesh, Notices& notices) {
  std::vector<bool> used(mesh.positions.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) used[corner] = true;
  note_dropped(notices, static_cast<std::size_t>(std::ranges::count(used, false)), " unreferenced");
}

std::vector<std::uint32_t> first_of_place(std::span<const glm::dvec3> positions, StopCheck& check) {
  std::vector<std::uint32_t> first(positions.size());
  std::vector<std::uint32_t> table(std::bit_ceil(2 * positions.size() + 1), no_vertex);
  for_each_checked(0, positions.size(), check, [&](std::size_t i) {
    std::size_t slot = hash_of_position(positions[i]) & (table.size() - 1);
    while (table[slot] != no_vertex && positions[table[slot]] != positions[i]) slot = (slot + 1) & (table.size() - 1);
    if (table[slot] == no_vertex) table[slot] = static_cast<std::uint32_t>(i);
    first[i] = table[slot];
  });
  return first;
}

std::vector<Sample> samples_at_vertices(Mesh& mesh, double crease, Notices& notices, const std::stop_token& stop) {
  if (!(crease >= 0 && crease <= 180))
    throw std::invalid_argument("crease angle must be from 0 to 180 degrees (got " + std::to_string(crease) + ")");
  VertexMaker(mesh, crease, stop).make();
  std::vector<Sample> samples;
  samples.reserve(mesh.positions.size());
  std::size_t without_normal = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (mesh.normals[i] == glm::dvec3{0.0})
      ++without_normal;
    else if (mesh.file_vertices[i] != no_vertex)
      samples.push_back({.position = mesh.positions[i], .normal = mesh.normals[i], .vertex = mesh.file_vertices[i]});
  }
  note_dropped(notices, without_normal, "", ": no triangle around has an area");
  return samples;
}

}  // namespace detp::sim
