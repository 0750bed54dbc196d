#include "outliers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <utility>

#include "detp/sim/base/stop_check.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

constexpr double far_boxes = 4;
constexpr double large_radii = 10;
constexpr double heavy_radii = 4;
constexpr double heavy_mean = 1.1;
constexpr double far_radii = 100;

std::vector<sim::Disc> evenly_spaced(std::span<const sim::Disc> discs) {
  const std::size_t count = std::min<std::size_t>(4096, discs.size());
  std::vector<sim::Disc> sampled;
  for (std::size_t i = 0; i < count; ++i) sampled.push_back(discs[i * discs.size() / count]);
  return sampled;
}

double longest(const sim::Box& box) {
  const glm::dvec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

/// Leaves out the lowest and the highest twentieth of the centres on each axis.
sim::Box central_box(const std::vector<sim::Disc>& discs) {
  const std::size_t left_out = discs.size() / 20;
  sim::Box box;
  std::vector<double> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const sim::Disc& disc : discs) values.push_back(disc.centre[axis]);
    std::sort(values.begin(), values.end());
    box.low[axis] = values[left_out];
    box.high[axis] = values[values.size() - 1 - left_out];
  }
  return box;
}

double median_radius(const std::vector<sim::Disc>& discs) {
  std::vector<double> radii;
  for (const sim::Disc& disc : discs) radii.push_back(disc.radius);
  return median(std::move(radii));
}

/// "1 of 10000 discs is" or "20 of 10000 discs are".
std::string count_text(std::size_t some, std::size_t all, const char* what, const char* one, const char* many) {
  return fmt::format("{} of {} {} {}", some, all, what, some == 1 ? one : many);
}

void warn_of_far_discs(std::span<const sim::Disc> discs, const std::vector<sim::Disc>& sampled, double radius,
                       sim::StopCheck& check, std::vector<std::string>& warnings) {
  sim::Box whole;
  sim::for_each_checked(discs, check, [&](const sim::Disc& disc) { whole.include(disc.centre); });
  const sim::Box centre = central_box(sampled);
  const double reach = std::max(longest(centre), 2 * radius);  // the discs' diameter if that is larger
  if (!(longest(whole) > far_boxes * reach)) return;
  std::size_t far = 0;
  sim::for_each_checked(discs, check, [&](const sim::Disc& disc) {
    const bool outside = glm::any(glm::lessThan(disc.centre, centre.low - reach)) ||
                         glm::any(glm::greaterThan(disc.centre, centre.high + reach));
    far += outside ? 1 : 0;
  });
  warnings.push_back(fmt::format(
      "{} far from the others: the box of all is {:.3g} long, {:.3g} times that of the central 90 % ({:.3g}); "
      "predictions, S0 and percentages take the box of all, as if discs were spread over it",
      count_text(far, discs.size(), "discs", "lies", "lie"), longest(whole), longest(whole) / reach, reach));
}

void warn_of_large_discs(std::span<const sim::Disc> discs, double median, sim::StopCheck& check,
                         std::vector<std::string>& warnings) {
  double largest = 0;
  double squares = 0;
  std::size_t large = 0;
  sim::for_each_checked(discs, check, [&](const sim::Disc& disc) {
    largest = std::max(largest, disc.radius);
    squares += disc.radius / median * (disc.radius / median);
    large += disc.radius > heavy_radii * median ? 1 : 0;
  });
  const double rms = std::sqrt(squares / static_cast<double>(discs.size()));
  if (!(largest > large_radii * median || (largest > heavy_radii * median && rms > heavy_mean))) return;
  const std::string radius = large == 1 ? "a radius of" : "radii up to";
  warnings.push_back(
      fmt::format("{} {} {:.4g}, {:.3g} times the median {:.4g}: predictions use the root mean square "
                  "{:.4g} for all, and S0 is made to hold the largest",
                  count_text(large, discs.size(), "discs", "has", "have"), radius, largest, largest / median, median,
                  rms * median));
}

void warn_of_far_rays(const sim::Problem& problem, sim::StopCheck& check, std::vector<std::string>& warnings) {
  const double radius = problem.enclosing().radius;
  double farthest = 0;
  std::size_t far = 0;
  sim::for_each_checked(problem.rays(), check, [&](const sim::Ray& ray) {
    const double distance = glm::length(ray.origin - problem.enclosing().centre);
    farthest = std::max(farthest, distance);
    far += distance > far_radii * radius ? 1 : 0;
  });
  if (far == 0) return;
  warnings.push_back(fmt::format(
      "{} far outside: up to {:.3g} from the centre of the scene, {:.3g} times the radius {:.4g} of S0; every cull is "
      "widened by {:.2g} for rounding over this distance",
      count_text(far, problem.rays().size(), "rays", "starts", "start"), farthest, farthest / radius, radius,
      problem.slack()));
}

}  // namespace

std::vector<std::string> outlier_warnings(const sim::Problem& problem, const std::stop_token& stop) {
  sim::StopCheck check(stop, "looking for outliers");
  const std::vector<sim::Disc> sampled = evenly_spaced(problem.discs());
  const double usual = median_radius(sampled);
  std::vector<std::string> warnings;
  warn_of_far_discs(problem.discs(), sampled, usual, check, warnings);
  warn_of_large_discs(problem.discs(), usual, check, warnings);
  warn_of_far_rays(problem, check, warnings);
  return warnings;
}

}  // namespace detp::validate
