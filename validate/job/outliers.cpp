#include "outliers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/effects/far_discs.hpp"

namespace detp::validate {
namespace {

constexpr double large_radii = 10;
constexpr double heavy_radii = 4;
constexpr double heavy_mean = 1.1;
constexpr double far_radii = 100;

/// "1 of 10000 discs is" or "20 of 10000 discs are".
std::string count_text(std::size_t some, std::size_t all, const char* what, const char* one, const char* many) {
  return fmt::format("{} of {} {} {}", some, all, what, some == 1 ? one : many);
}

void warn_of_far_discs(const sim::Problem& problem, const std::stop_token& stop, std::vector<std::string>& warnings) {
  const std::optional<sim::FarDiscs> found = sim::find_far_discs(problem, stop);
  if (!found) return;
  const double all = problem.centres().longest_side();
  warnings.push_back(fmt::format(
      "{} far from the others: the box of all is {:.3g} long, {:.3g} times that of the central 90 % ({:.3g}); S0 and "
      "percentages take the box of all; predictions of box trees know where discs are, those of other techniques "
      "spread all discs over the box of all",
      count_text(found->far, problem.discs().size(), "discs", "lies", "lie"), all, all / found->reach, found->reach));
}

void warn_of_large_discs(const sim::Problem& problem, sim::StopCheck& check, std::vector<std::string>& warnings) {
  const double median = sim::median_radius(sim::evenly_spaced(problem.discs()));
  const double largest = problem.radii().largest;
  const double rms = problem.radii().rms;
  if (!(largest > large_radii * median || (largest > heavy_radii * median && rms > heavy_mean * median))) return;
  std::size_t large = 0;
  sim::for_each_checked(problem.discs(), check,
                        [&](const sim::Disc& disc) { large += disc.radius > heavy_radii * median ? 1 : 0; });
  const std::string radius = large == 1 ? "a radius of" : "radii up to";
  warnings.push_back(
      fmt::format("{} {} {:.4g}, {:.3g} times the median {:.4g}: S0 is made to hold the largest; predictions of "
                  "box trees use all radii, those of other techniques mostly the root mean square {:.4g}",
                  count_text(large, problem.discs().size(), "discs", "has", "have"), radius, largest, largest / median,
                  median, rms));
}

void warn_of_far_rays(const sim::Problem& problem, sim::StopCheck& check, std::vector<std::string>& warnings) {
  const double radius = problem.enclosing().radius;
  if (problem.farthest() <= far_radii * radius) return;
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
  std::vector<std::string> warnings;
  warn_of_far_discs(problem, stop, warnings);
  warn_of_large_discs(problem, check, warnings);
  warn_of_far_rays(problem, check, warnings);
  return warnings;
}

}  // namespace detp::validate
