#include "box_tree_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "box_tree_boxes.hpp"
#include "detp/model/lines/line_measure.hpp"

namespace detp::model::box_tree {
namespace {

double interpolated(double high, double low, double weight) {
  if (!(low > 0 && high > 0)) return weight * high + (1 - weight) * low;
  return std::pow(high, weight) * std::pow(low, 1 - weight);
}

/// Calls f(coefficients of `more`, of `less`, of `boxes`) for each polynomial.
template <class F>
void for_each_polynomial(const NodeBoxes& more, const NodeBoxes& less, NodeBoxes& boxes, const F& f) {
  f(more.surface, less.surface, boxes.surface);
  f(more.squares, less.squares, boxes.squares);
  f(more.volume, less.volume, boxes.volume);
}

NodeBoxes between(const NodeBoxes& more, const NodeBoxes& less, double discs) {
  const double weight = std::log(discs / less.samples) / std::log(more.samples / less.samples);
  NodeBoxes boxes{.samples = discs};
  for_each_polynomial(more, less, boxes, [weight](const auto& high, const auto& low, auto& mean) {
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] = interpolated(high[k], low[k], weight);
  });
  return boxes;
}

/// Between the smallest measured boxes and those of single discs. `power`: of m, in a length.
NodeBoxes below(const NodeBoxes& smallest, const NodeBoxes& single, double discs, double power) {
  if (discs <= 1) return single;
  const auto filled = [](double m) { return (m - 1) / (m + 1); };
  const double ratio = std::pow(discs / smallest.samples, power) * filled(discs) / filled(smallest.samples);
  const double weight = (1 - 1 / discs) / (1 - 1 / smallest.samples);
  NodeBoxes boxes{.samples = discs};
  for_each_polynomial(smallest, single, boxes, [&](const auto& high, const auto& low, auto& mean) {
    const std::size_t last = mean.size() - 1;
    double length = 1;
    for (std::size_t k = last; k-- > 0;) mean[k] = high[k] * (length *= ratio);
    mean[last] = weight * high[last] + (1 - weight) * low[last];
  });
  return boxes;
}

/// The power of m with which lengths grow, from the smallest boxes to those with 16 times as many samples.
double power_of_lengths(const std::vector<NodeBoxes>& all) {
  const NodeBoxes& smallest = all[all.size() - 2];
  const NodeBoxes* large = &all.front();
  for (const NodeBoxes& one : all)
    if (one.samples >= 16 * smallest.samples) large = &one;
  if (!(large->edges > smallest.edges && smallest.edges > 0)) return 1.0 / 3;
  return std::clamp(std::log(large->edges / smallest.edges) / std::log(large->samples / smallest.samples), 1.0 / 3,
                    1.0);
}

template <std::size_t n>
double value(const std::array<double, n>& polynomial, double d) {
  double sum = 0;
  for (std::size_t k = n; k-- > 0;) sum = sum * d + polynomial[k];
  return sum;
}

}  // namespace

NodeBoxes ClusteredNodes::boxes_of(double discs) const {
  const auto& all = workload_.nodes;
  const auto smaller =
      std::find_if(all.begin(), all.end(), [discs](const NodeBoxes& one) { return one.samples <= discs; });
  if (smaller == all.begin()) return all.front();
  if (smaller >= all.end() - 1) return below(all[all.size() - 2], all.back(), discs, power_);
  return between(*(smaller - 1), *smaller, discs);
}

ClusteredNodes::ClusteredNodes(const Valid<Workload>& workload, Engine engine, double margin)
    : workload_(workload), engine_(engine), margin_(2 * margin), power_(power_of_lengths(workload.nodes)) {}

double ClusteredNodes::crossing(double discs) const {
  const NodeBoxes boxes = boxes_of(discs);
  const double d = largest_radius(workload_, discs);
  const double edges = std::sqrt(3 * value(boxes.squares, d));  // an upper bound, for the margin alone
  const double squares = value(boxes.squares, d) + margin_ * (2 * edges + 3 * margin_);
  const double surface = value(boxes.surface, d) + margin_ * (4 * edges + 6 * margin_) +
                         (engine_ == Engine::simd ? 2 * listed_beyond * squares : 0);
  return crossing_probability(workload_, value(boxes.volume, d), surface);
}

}  // namespace detp::model::box_tree
