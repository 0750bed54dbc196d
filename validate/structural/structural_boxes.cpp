#include "structural_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detp/sim/base/stop_check.hpp"

namespace detp::validate {
namespace {

using sim::stream::TreeNode;
using std::numbers::pi;

/// A line of one class: its slopes a and b, and the place (u, v) in the rectangle of listed lines at which it crosses
/// the rectangle; each number from -1 to 1.
struct PoolLine {
  double a, b, u, v;
  double weight;  ///< weight of its direction: (1 + a² + b²)^{-2}
};

constexpr std::size_t listed_pool_size = 4096;

/// The numbers (a, b, u, v) of the lines are the points of Roberts's sequence in four dimensions. The points, and their
/// projections onto fewer dimensions, are evenly distributed.
std::vector<PoolLine> make_listed_pool() {
  constexpr double root = 1.1673039782614187;  // x⁵ = x + 1
  std::vector<PoolLine> pool;
  pool.reserve(listed_pool_size);
  for (std::size_t i = 0; i < listed_pool_size; ++i) {
    const auto place = [i](int power) {
      const double at = 0.5 + static_cast<double>(i + 1) * std::pow(root, -power);
      return 2 * (at - std::floor(at)) - 1;
    };
    PoolLine line{place(1), place(2), place(3), place(4), 0};
    const double stretch = 1 + line.a * line.a + line.b * line.b;
    line.weight = 1 / (stretch * stretch);
    pool.push_back(line);
  }
  return pool;
}

using Triple = std::array<double, 3>;

/// True if the line x = p + a z, y = q + b z crosses the box around the origin. Requires that the line crosses the
/// projections of the box along x and along y.
bool crosses(double p, double a, double q, double b, const Triple& half, int x, int y, int z) {
  const auto between = [&](double at, double slope, double most, double sign) {
    return slope == 0 ? sign * half[z] : (sign * std::copysign(most, slope) - at) / slope;
  };
  const double low = std::max({-half[z], between(p, a, half[x], -1), between(q, b, half[y], -1)});
  const double high = std::min({half[z], between(p, a, half[x], 1), between(q, b, half[y], 1)});
  return low <= high;
}

/// Of the lines that are listed for a box, the share that crosses the sphere of that radius around the origin.
double share_through(double radius, const Triple& centre, const Triple& half, std::size_t lines, Engine engine) {
  static const std::vector<PoolLine> pool = make_listed_pool();
  double all = 0;
  double through = 0;
  for (int k = 0; k < sim::stream::classes; ++k) {
    const auto [x, y, z] = sim::stream::axes_of_class(k);
    for (std::size_t i = 0; i < lines; ++i) {
      const PoolLine& line = pool[i];
      const double wide = half[x] + std::abs(line.a) * half[z];
      const double high = half[y] + std::abs(line.b) * half[z];
      if (engine == Engine::plain && !crosses(line.u * wide, line.a, line.v * high, line.b, half, x, y, z)) continue;
      const double weight = line.weight * wide * high;
      const double p = centre[x] + line.u * wide - line.a * centre[z];
      const double q = centre[y] + line.v * high - line.b * centre[z];
      const double turn = p * line.b - q * line.a;
      const double stretch = 1 + line.a * line.a + line.b * line.b;
      all += weight;
      if (p * p + q * q + turn * turn <= radius * radius * stretch) through += weight;
    }
  }
  return all > 0 ? through / all : 1;
}

}  // namespace

BoxCrossing::BoxCrossing(double outer_radius, double margin, Engine engine)
    : outer_(outer_radius), margin_(margin), engine_(engine) {}

double BoxCrossing::operator()(const TreeNode& box) const {
  const Triple centre{box.centre[0], box.centre[1], box.centre[2]};
  const Triple half{box.half[0] + margin_, box.half[1] + margin_, box.half[2] + margin_};
  const double products = half[0] * half[1] + half[1] * half[2] + half[2] * half[0];
  const double squares = half[0] * half[0] + half[1] * half[1] + half[2] * half[2];
  const double missing = engine_ == Engine::simd ? std::log(4.0 / 3) / pi * squares : 0;
  const double share = 2 / (pi * outer_ * outer_) * (products + missing);
  // A listed line of class z crosses the plane through the centre within (h_x + h_z, h_y + h_z) of the centre.
  double reach = 0;
  for (int z = 0; z < 3; ++z)
    reach = std::max(reach, std::hypot(half[(z + 1) % 3] + half[z], half[(z + 2) % 3] + half[z]));
  if (std::hypot(centre[0], centre[1], centre[2]) + reach <= outer_) return share;
  const auto lines = static_cast<std::size_t>(std::clamp(16 * listed_pool_size * share, 64.0, 1.0 * listed_pool_size));
  return std::min(1.0, share * share_through(outer_, centre, half, lines, engine_));
}

Counts<double> counts_of(const sim::Problem& problem, const Lines& lines, const BoxTreeParameters& parameters,
                         const std::stop_token& stop) {
  const sim::stream::Frame frame(problem);
  const sim::stream::DiscTree tree = sim::stream::make_disc_tree(problem, frame, parameters, {.stop = stop});
  const BoxCrossing crossing(problem.enclosing().radius * frame.scale, frame.margin, lines.engine);
  const auto discs = static_cast<double>(problem.discs().size());
  const RayBlocks blocks = lines.blocks(problem);
  Counts<double> counts{
      .references = discs, .placements = discs, .made = static_cast<double>(tree.binary_nodes), .sorted = discs};
  sim::StopCheck check(stop, "counting boxes");
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    const double listed = i == 0 ? 1 : crossing(node);
    check.after(listed_pool_size);  // at most as many lines were used for the node
    if (i > 0) counts.listed += listed;
    const auto count = static_cast<double>(node.count);
    // A node's children are tested, and a leaf's discs visited, if the node's list holds at least one ray of the block.
    (node.leaf ? counts.disc_tests : counts.cull_tests) += listed * count;
    (node.leaf ? counts.visits : counts.culls) += count * blocks.with_any(listed);
  }
  for (const auto per_ray : {&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests})
    counts.*per_ray *= lines.rays;
  return counts;
}

}  // namespace detp::validate
