#include "view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/threads.hpp"

namespace detp::sim {
namespace {

constexpr double flat = 0.02;              // thickness over width
constexpr double usual_half_height = 0.4;  // 44 degrees
constexpr double margin = 1.05;
constexpr double flattest_aspect = 2.5;    // of a plan
constexpr double wide_half_height = 0.75;  // 74 degrees, within a room
constexpr double worth_within = 0.8;       // of a view from within the box, which shows less of the whole
constexpr std::size_t sights_tried = 500;
constexpr double pi = 3.14159265358979323846;

/// Coordinates of the picture.
struct Frame {
  glm::dvec3 forward;
  glm::dvec3 right;
  glm::dvec3 up;

  explicit Frame(const View& view)
      : forward(glm::normalize(view.to - view.from)),
        right(glm::normalize(glm::cross(forward, view.up))),
        up(glm::cross(right, forward)) {}
};

/// The view in this direction that just shows all the places, in its middle.
View around(std::span<const glm::dvec3> places, const glm::dvec3& middle, const glm::dvec3& direction,
            const glm::dvec3& up) {
  View view{middle - direction, middle, up, usual_half_height};
  const Frame frame(view);
  // Lines of sight at the picture's edges, x = ± tangent z + c, that leave all places within: the widest c on each side.
  const auto edges = [&](const glm::dvec3& across, double tangent) {
    std::array<double, 2> widest{-unbounded, -unbounded};
    for (const glm::dvec3& place : places) {
      const double x = glm::dot(place - middle, across);
      const double z = tangent * glm::dot(place - middle, frame.forward);
      widest[0] = std::max(widest[0], x - z);
      widest[1] = std::max(widest[1], -x - z);
    }
    return widest;
  };
  const double tangent = usual_half_height / margin;
  const auto vertical = edges(frame.up, tangent);
  const auto horizontal = edges(frame.right, tangent * view.aspect);
  // At the eye both edges meet, x = (c - c') / 2, at the depth -(c + c') / 2 / tangent.
  const double depth =
      std::max(vertical[0] + vertical[1], (horizontal[0] + horizontal[1]) / view.aspect) / (2 * tangent);
  const glm::dvec3 shift =
      0.5 * (horizontal[0] - horizontal[1]) * frame.right + 0.5 * (vertical[0] - vertical[1]) * frame.up;
  view.from = middle + shift - depth * frame.forward;
  view.to = middle + shift;
  return view;
}

/// From outside the box along an axis.
View plan_of(const Box& box, int axis, double sign, const glm::dvec3& up) {
  glm::dvec3 direction{0.0};
  direction[axis] = sign;
  View view{box.centre() - box.longest_side() * direction, box.centre(), up, 0, true};
  const Frame frame(view);
  const auto across = [&](const glm::dvec3& along) { return std::abs(glm::dot(box.size(), along)); };
  view.aspect = std::clamp(across(frame.right) / across(frame.up), 1 / flattest_aspect, flattest_aspect);
  view.half_height = 0.5 * margin * std::max(across(frame.up), across(frame.right) / view.aspect);
  return view;
}

/// The mesh's outermost corners in 26 directions.
std::vector<glm::dvec3> outermost(const Mesh& mesh, StopCheck& check) {
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 27; ++i)
    if (i != 13) directions.push_back(glm::normalize(glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
  std::vector<double> farthest(directions.size(), -unbounded);
  std::vector<glm::dvec3> places(directions.size());
  for (const auto& corners : mesh.triangles) {
    check.after(1);
    for (const std::uint32_t corner : corners)
      for (std::size_t i = 0; i < directions.size(); ++i) {
        const double far = glm::dot(mesh.positions[corner], directions[i]);
        if (far <= farthest[i]) continue;
        farthest[i] = far;
        places[i] = mesh.positions[corner];
      }
  }
  return places;
}

std::vector<View> candidates(const Mesh& mesh, const Up& up, StopCheck& check) {
  const Box box = used_box(mesh);
  const glm::dvec3 up_vector = up.from_y({0, 1, 0});
  const glm::dvec3 size = box.size();
  std::array<int, 3> axes{0, 1, 2};
  std::ranges::sort(axes, {}, [&](int axis) { return size[axis]; });
  std::vector<View> views;
  if (size[axes[0]] < flat * size[axes[1]]) {
    const glm::dvec3 in_plan = axes[0] == up.axis ? up.from_y({0, 0, -1}) : up_vector;
    for (const double sign : {-1.0, 1.0}) views.push_back(plan_of(box, axes[0], sign, in_plan));
    return views;
  }
  const std::vector<glm::dvec3> places = outermost(mesh, check);
  constexpr int azimuths = 12;
  for (const double elevation : {0.5, 0.1, 0.95})
    for (int i = 0; i < azimuths; ++i) {
      const double azimuth = 2 * pi * (i + 1) / azimuths;  // begins beside the front
      const glm::dvec3 from{std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                            std::cos(elevation) * std::cos(azimuth)};
      views.push_back(around(places, box.centre(), -up.from_y(from), up_vector));
    }
  const glm::dvec3 half = 0.5 * up.to_y(size);
  for (int i = 0; i < 8; ++i) {
    const double angle = pi / 4 * i;
    const auto side = [](double x) { return std::abs(x) < 0.1 ? 0.0 : std::copysign(0.88, x); };
    const glm::dvec3 place{side(std::sin(angle)) * half.x, 0.15 * std::abs(half.y), side(std::cos(angle)) * half.z};
    const glm::dvec3 target{0.0, -0.1 * std::abs(half.y), 0.0};
    views.push_back({box.centre() + up.from_y(place), box.centre() + up.from_y(target), up_vector, wide_half_height});
  }
  return views;
}

double seen_of(const RayCaster& caster, const View& view, std::span<const Sight> sights, std::size_t every) {
  const Frame frame(view);
  double sum = 0;
  for (std::size_t i = 0; i < sights.size(); i += every) {
    const Sight& sight = sights[i];
    const glm::dvec3 to = sight.place - view.from;
    const double depth = glm::dot(to, frame.forward);
    const double room = view.half_height * (view.plan ? 1 : depth);
    if (depth <= 0 || std::abs(glm::dot(to, frame.up)) > room ||
        std::abs(glm::dot(to, frame.right)) > view.aspect * room)
      continue;
    const glm::dvec3 direction = view.plan ? frame.forward : glm::normalize(to);
    const double cosine = -glm::dot(direction, sight.normal);
    if (cosine <= 0) continue;
    const double distance = (view.plan ? depth : glm::length(to)) / caster.scale();
    const glm::dvec3 origin = caster.to_caster(sight.place) - distance * direction;
    if (!caster.first_intersection(origin, direction, std::nullopt, distance * (1 - 1e-3)))
      sum += sight.weight * cosine;
  }
  return view.half_height == wide_half_height ? worth_within * sum : sum;
}

}  // namespace

View view_between(const glm::dvec3& from, const glm::dvec3& to, const Up& up) {
  for (const glm::dvec3& place : {from, to})
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(place[axis]) <= largest_coordinate))
        throw std::invalid_argument("the places of a view must be finite");
  const double distance = glm::length(to - from);
  if (!(distance > 0)) throw std::invalid_argument("a view must lead from one place to another");
  View view{from, to, up.from_y({0, 1, 0})};
  if (std::abs(glm::dot((to - from) / distance, view.up)) > 0.999) view.up = up.from_y({0, 0, -1});
  return view;
}

View view_of_most(const RayCaster& caster, const Mesh& mesh, const Up& up, std::span<const Sight> sights,
                  const std::stop_token& stop) {
  const std::size_t every = std::max<std::size_t>(1, sights.size() / sights_tried);
  StopCheck check(stop, "looking for a view");
  const std::vector<View> views = candidates(mesh, up, check);
  View best = views.front();
  double most = 0;
  for (const View& view : views) {
    check.after(sights.size() / every);
    const double sum = seen_of(caster, view, sights, every);
    if (sum <= most * (1 + 1e-9)) continue;
    most = sum;
    best = view;
  }
  return best;
}

Cells::Cells(const View& view, double count)
    : width(step * std::max(1, static_cast<int>(std::lround(std::sqrt(count * view.aspect) / step)))),
      height(step * std::max(1, static_cast<int>(std::lround(std::sqrt(count / view.aspect) / step)))) {}

std::vector<Seen> look(const RayCaster& caster, const Mesh& mesh, const View& view, const Cells& cells, int threads,
                       const std::stop_token& stop) {
  const Frame frame(view);
  const double cell = 2 * view.half_height / cells.height;
  std::vector<Seen> seen(cells.count());
  const auto look_at = [&](int x, int y) {
    const glm::dvec3 beside =
        cell * ((x + 0.5 - 0.5 * cells.width) * frame.right + (0.5 * cells.height - y - 0.5) * frame.up);
    const glm::dvec3 start = view.plan ? view.from + beside : view.from;
    const glm::dvec3 direction = view.plan ? frame.forward : glm::normalize(frame.forward + beside);
    const auto met = caster.first_intersection(caster.to_caster(start), direction);
    if (!met) return Seen{};
    const glm::dvec3 place = start + met->distance * caster.scale() * direction;
    const auto& [a, b, c] = mesh.triangles[met->triangle];
    const glm::dvec3 first = mesh.positions[b] - mesh.positions[a];
    const glm::dvec3 second = mesh.positions[c] - mesh.positions[a];
    const glm::dvec3 normal = glm::cross(first, second);
    const double area = glm::dot(normal, normal);
    const glm::dvec3 at = place - mesh.positions[a];
    return Seen{met->triangle, glm::dot(normal, glm::cross(at, second)) / area,
                glm::dot(normal, glm::cross(first, at)) / area, glm::dot(place - view.from, frame.forward)};
  };
  on_threads(thread_count(threads), [&] {
    sim::parallel_for(0, cells.height, [&](int y) {
      if (stop.stop_requested()) return;
      for (int x = 0; x < cells.width; ++x) seen[cells.index(x, y)] = look_at(x, y);
    });
  });
  if (stop.stop_requested()) throw Stopped("stopped while drawing a picture");
  return seen;
}

std::vector<char> outlines(std::span<const Seen> seen, const Mesh& mesh, const View& view, const Cells& cells) {
  constexpr double bend = 0.866;  // cosine of 30 degrees
  const auto normal_of = [&](const Seen& one) {
    const auto& [a, b, c] = mesh.triangles[one.triangle];
    return glm::normalize(glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
  };
  // A surface seen at a grazing angle falls off fast, without an edge: its depth is compared with that of a plane.
  const double cell = 2 * view.half_height / cells.height;
  const Frame frame(view);
  const auto behind = [&](const Seen& one, const Seen& other) {
    if (!other.anything()) return false;
    if (!one.anything()) return true;
    if (one.triangle == other.triangle) return false;
    const glm::dvec3 normal = normal_of(one);
    const glm::dvec3 its = normal_of(other);
    const double step = cell * (view.plan ? 1 : std::min(one.depth, other.depth));
    const double slope =
        1 / std::max(0.05, std::min(std::abs(glm::dot(normal, frame.forward)), std::abs(glm::dot(its, frame.forward))));
    if (one.depth - other.depth > 4 * slope * step) return true;
    return one.depth >= other.depth && std::abs(glm::dot(normal, its)) < bend;
  };
  std::vector<char> marked(seen.size());
  for (int y = 0; y < cells.height; ++y)
    for (int x = 0; x < cells.width; ++x) {
      const auto behind_at = [&](int i, int j) { return behind(seen[cells.index(x, y)], seen[cells.index(i, j)]); };
      const bool edge = (x > 0 && behind_at(x - 1, y)) || (x + 1 < cells.width && behind_at(x + 1, y)) ||
                        (y > 0 && behind_at(x, y - 1)) || (y + 1 < cells.height && behind_at(x, y + 1));
      marked[cells.index(x, y)] = edge ? 1 : 0;
    }
  return marked;
}

}  // namespace detp::sim
