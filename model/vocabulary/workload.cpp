#include "workload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "checks.hpp"

namespace detp {
namespace {

double longest(const std::array<double, 3>& box) { return *std::max_element(box.begin(), box.end()); }

void check_radii(const Workload& workload) {
  if (workload.radii.empty()) return;
  constexpr double rounding = 1e-6;
  double shares = 0;
  double squares = 0;
  double above = HUGE_VAL;
  for (const RadiusClass& one : workload.radii) {
    require_positive("radius of a class of discs", one.radius);
    require_positive("share of a class of discs", one.share);
    if (!(one.radius < above)) throw std::invalid_argument("classes of radii must begin with the largest radius");
    above = one.radius;
    shares += one.share;
    const double ratio = one.radius / workload.disc_radius;
    squares += one.share * ratio * ratio;
  }
  if (!(std::abs(shares - 1) <= rounding))
    throw std::invalid_argument(fmt::format("shares of classes of radii must add up to 1 (got {})", shares));
  if (!(std::abs(squares - 1) <= 2 * rounding))
    throw std::invalid_argument(
        fmt::format("disc radius must be the root mean square of the classes of radii (got {}, not {})",
                    workload.disc_radius, workload.disc_radius * std::sqrt(squares)));
}

void check_box(const std::array<double, 3>& box, double dimension, double sample_extent) {
  for (const double side : box) require_non_negative("side of the sample box", side);
  if (!(dimension >= 1 && dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 1 to 3 (got {})", dimension));
  require_non_negative("sample extent", sample_extent);
  require_positive("longest side of the sample box", longest(box));
  if (sample_extent > 1e270)
    throw std::invalid_argument(
        fmt::format("sample extent must be at most 1e270, or it overflows (got {})", sample_extent));
}

void check_lengths(double sphere_radius, double side) {
  for (const double length : {sphere_radius, side})
    if (length < 1e-90 || length > 1e90)
      throw std::invalid_argument(fmt::format(
          "sphere radius and sample box must lie between 1e-90 and 1e90, or their volumes overflow (got {})", length));
}

void check_nodes(const Workload& workload) {
  if (workload.nodes.empty()) return;
  double before = std::numeric_limits<double>::infinity();
  for (const NodeBoxes& node : workload.nodes) {
    if (!(node.samples >= 1 && node.samples < before))
      throw std::invalid_argument(fmt::format(
          "boxes around samples must hold fewer samples from one to the next, at least 1 (got {})", node.samples));
    before = node.samples;
    require_non_negative("edges of the boxes around samples", node.edges);
    for (const double one : node.surface) require_non_negative("surface of the boxes around samples", one);
    for (const double one : node.squares) require_non_negative("squares of the boxes around samples", one);
    for (const double one : node.volume) require_non_negative("volume of the boxes around samples", one);
  }
  if (workload.nodes.size() < 2 || workload.nodes.back().samples != 1)
    throw std::invalid_argument("the last of at least two boxes around samples must hold one sample");
}

}  // namespace

void check(const Workload& workload) {
  require_count("number of rays", workload.rays, 1, 1e18);
  require_count("number of samples", workload.samples, 1, 1e18);
  require_positive("disc radius", workload.disc_radius);
  check_radii(workload);
  require_positive("sphere radius", workload.sphere_radius);
  check_box(workload.box, workload.dimension, workload.sample_extent);
  require_non_negative("sample distance", workload.sample_distance);
  require_non_negative("path length", workload.path_length);
  require_positive("density of the rays", workload.ray_density);
  require_positive("ratio of the hits", workload.hit_ratio);
  check_lengths(workload.sphere_radius, scene_side(workload));
  check_nodes(workload);
}

double sample_extent(const Workload& workload) {
  if (workload.sample_extent > 0) return workload.sample_extent;
  // A flat box has no volume. Its sides count as at least 1e-6 of the longest, so that no density becomes infinite.
  const double sliver = 1e-6 * scene_side(workload);
  std::array<double, 3> side = workload.box;
  for (double& length : side) length = std::max(length, sliver);
  const double volume = side[0] * side[1] * side[2];
  const double area = 2 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]);
  const double weight = std::clamp(workload.dimension - 2, 0.0, 1.0);
  return std::pow(volume, weight) * std::pow(area, 1 - weight);
}

double sample_distance(const Workload& workload) {
  if (workload.sample_distance > 0) return workload.sample_distance;
  const long double share = static_cast<long double>(sample_extent(workload)) / workload.samples;
  return static_cast<double>(std::pow(share, 1.0L / workload.dimension));
}

double largest_radius(const Workload& workload) {
  return workload.radii.empty() ? workload.disc_radius : workload.radii.front().radius;
}

double largest_radius(const Workload& workload, double discs) {
  if (workload.radii.empty()) return workload.disc_radius;
  double sum = 0;
  double larger = 0;  // share of the discs in larger classes
  double none_larger = 1;
  for (const RadiusClass& one : workload.radii) {
    larger += one.share;
    const double none = larger < 1 ? std::exp(discs * std::log1p(-larger)) : 0;
    sum += (none_larger - none) * one.radius;
    none_larger = none;
  }
  return sum + none_larger * workload.radii.back().radius;
}

Workload with_disc_radius(Workload workload, double disc_radius) {
  const double ratio = disc_radius / workload.disc_radius;
  const double growth = (ratio - 1) * largest_radius(workload);
  workload.sphere_radius += growth;
  workload.disc_radius = disc_radius;
  for (RadiusClass& one : workload.radii) one.radius *= ratio;
  return workload;
}

double scene_side(const Workload& workload) { return longest(workload.box); }

double enclosing_radius(double side, double disc_radius) { return side * (std::sqrt(3.0) / 2) + disc_radius; }

Workload cube_workload(double rays, double samples, double disc_radius, double side, double dimension) {
  return {.rays = rays,
          .samples = samples,
          .disc_radius = disc_radius,
          .sphere_radius = enclosing_radius(side, disc_radius),
          .box = {side, side, side},
          .dimension = dimension};
}

}  // namespace detp
