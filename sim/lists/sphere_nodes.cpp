#include "sphere_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

/// A sphere, and the box of the centres of the discs in it.
struct Node {
  Sphere sphere;
  Box box;
};

/// The child whose sphere reaches farthest from a point: the distance of its farthest point, the direction to its
/// centre.
struct FarthestSphere {
  double distance = 0;
  glm::dvec3 towards{0};  ///< unit length, or zero if the point is the child's centre
};

FarthestSphere farthest_sphere(std::span<const Node> children, const glm::dvec3& from, StopCheck& check) {
  double largest = -1;
  glm::dvec3 offset{0};
  for (const Node& child : children) {
    const glm::dvec3 away = child.sphere.centre - from;
    const double distance = glm::length(away) + child.sphere.radius;
    if (distance > largest) {
      largest = distance;
      offset = away;
    }
    check.add(1);
  }
  check.after(0);
  const double length = glm::length(offset);
  return {largest, length > 0 ? offset / length : glm::dvec3{0}};
}

Node bounding_node(std::span<const Node> children, StopCheck& check) {
  constexpr int steps = 6;
  constexpr double first_step = 0.1;  // as a share of the farthest distance
  constexpr double shrink = 0.7;
  if (children.size() == 1) return children.front();
  Node node{{{}, unbounded}, {}};
  for (const Node& child : children) {
    node.box.include(child.box.low);
    node.box.include(child.box.high);
  }
  glm::dvec3 centre = node.box.centre();
  double step = first_step;
  for (int i = 0; i <= steps; ++i, step *= shrink) {
    const FarthestSphere farthest = farthest_sphere(children, centre, check);
    if (farthest.distance < node.sphere.radius) node.sphere = {centre, farthest.distance};
    centre += step * farthest.distance * farthest.towards;
  }
  return node;
}

/// The nodes one level above `below`: one for each `run` consecutive nodes.
std::vector<Node> level_above(const std::vector<Node>& below, std::size_t run, StopCheck& check) {
  std::vector<Node> level;
  level.reserve((below.size() - 1) / run + 1);
  for (std::size_t first = 0; first < below.size(); first += run) {
    level.push_back(bounding_node(std::span(below).subspan(first, std::min(run, below.size() - first)), check));
    check.after(1);
  }
  return level;
}

std::vector<Sphere> spheres_of(const std::vector<Node>& nodes) {
  std::vector<Sphere> spheres;
  spheres.reserve(nodes.size());
  for (const Node& node : nodes) spheres.push_back(node.sphere);
  return spheres;
}

}  // namespace

std::size_t SphereTree::nodes() const {
  std::size_t sum = 0;
  for (const std::vector<Sphere>& level : levels) sum += level.size();
  return sum;
}

SphereTree make_sphere_tree(std::span<const Disc> discs, std::span<const std::uint32_t> order,
                            const SphereTreeParameters& parameters, const std::stop_token& stop) {
  check({Technique::sphere_tree, parameters});
  require_count("number of discs", static_cast<double>(discs.size()), 1, 1e18);
  std::vector<Node> nodes;
  nodes.reserve(order.size());
  for (const std::uint32_t i : order)
    nodes.push_back({{discs[i].centre, discs[i].radius}, {discs[i].centre, discs[i].centre}});
  StopCheck check_stop(stop, "building the sphere tree");
  SphereTree tree;
  for (auto run = static_cast<std::size_t>(parameters.leaf);; run = static_cast<std::size_t>(parameters.fan_out)) {
    nodes = level_above(nodes, run, check_stop);
    tree.levels.push_back(spheres_of(nodes));
    if (nodes.size() == 1) return tree;
  }
}

}  // namespace detp::sim
