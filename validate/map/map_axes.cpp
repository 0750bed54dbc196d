#include "map_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace detp::validate {
namespace {

void require_few(std::string_view what, std::size_t values) {
  if (values > most_axis_values)
    throw std::length_error(fmt::format("a map has room for {} {}, not for {}: give at most {}, or make several maps",
                                        most_axis_values, what, values, most_axis_values));
}

}  // namespace

std::vector<double> default_map_rays() { return {100, 300, 1000, 3000, 10'000, 30'000, 100'000, 300'000}; }

std::vector<Length> default_map_radii() {
  std::vector<Length> radii;
  for (double share = 0.0025; share < 0.2; share *= 2) radii.push_back({share, true});
  return radii;
}

MapAxes checked(MapAxes axes) {
  for (const double rays : axes.rays) require_count("number of rays", rays, 1, 1e18);
  for (const Length& radius : axes.radii) require_positive("disc radius", radius.value);
  std::sort(axes.rays.begin(), axes.rays.end());
  axes.rays.erase(std::unique(axes.rays.begin(), axes.rays.end()), axes.rays.end());
  std::vector<Length> different;
  for (const Length& radius : axes.radii)
    if (std::find(different.begin(), different.end(), radius) == different.end()) different.push_back(radius);
  axes.radii = std::move(different);
  require_few("numbers of rays", axes.rays.size());
  require_few("disc radii", axes.radii.size());
  return axes;
}

std::vector<double> cell_edges(const std::vector<double>& values) {
  std::vector<double> edges{0};
  for (std::size_t i = 0; i + 1 < values.size(); ++i) edges.push_back(std::sqrt(values[i]) * std::sqrt(values[i + 1]));
  const double beyond = values.size() > 1 ? values.back() / edges.back() : std::sqrt(10.0);
  edges.front() = values.front() / (values.size() > 1 ? edges[1] / values.front() : beyond);
  edges.push_back(values.back() * beyond);
  return edges;
}

}  // namespace detp::validate
