#include "line_measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace detp::model {
namespace {

using std::numbers::pi;
constexpr long double exact_pi = std::numbers::pi_v<long double>;

void require_inside(std::string_view what, double size, double outer) {
  if (size > outer)
    throw std::invalid_argument(
        fmt::format("{} must not exceed the sphere radius {}, or it pokes out (got {})", what, outer, size));
}

/// With uniform rays. In long double, because d² or V_box may be below the range of doubles, and V + ℓF above it.
long double uniform_crossing(const Valid<Workload>& workload, long double volume, long double area) {
  const long double r0 = workload.sphere_radius;
  if (workload.path_length <= 0) return std::min(1.0L, area / (4 * exact_pi * r0 * r0));
  long double space = 1;
  for (const double side : workload.box) space *= side + 2.0L * workload.disc_radius;
  return std::min(1.0L, (volume + workload.path_length * area / 4) / space);
}

/// The integral over s, the distance of the circles' centres, runs from p to q > p. The integrand's next zero is at
/// f >= q. The differences are computed from a, b and c without cancellation.
struct Range {
  long double p;         // |a - b|
  long double q;         // min(c, a + b)
  long double f;         // max(c, a + b)
  long double q_less_p;  // <= 0: one sphere is inside the other
  long double f_less_q;
  bool meet;  // c < a + b
};

Range range_of(long double a, long double b, long double c) {
  const long double large = std::max(a, b);
  const long double small = std::min(a, b);
  const long double p = large - small;
  const long double sum = large + small;
  const long double short_of_sum = (large - c) + small;
  const bool meet = short_of_sum > 0;
  const long double c_less_p = small >= large / 2 ? c - p : (c - large) + small;
  return {p, std::min(c, sum), std::max(c, sum), meet ? c_less_p : 2 * small, std::abs(short_of_sum), meet};
}

/// A node of the trapezoidal rule over τ = ln((s - p)/(q - s)). For any p, q and f, all singularities other than s = p
/// and s = q lie on Im τ = ±π. So with step h the error is proportional to e^{-2π²/h}, times (2π/h)⁴ for the pole to
/// which s = ∞ is mapped.
struct Node {
  double v = 0;       // (s - p)/(q - p)
  double rest = 0;    // (q - s)/(q - p)
  double weight = 0;  // of √((q - s)(s - p)) ds / (q - p)²
};

const auto& nodes() {
  static const auto table = [] {
    constexpr double step = 0.4;
    constexpr int first = -98;  // the integrand decays at least as e^τ (slowest if a = b) …
    constexpr int last = 66;    // … and at least as e^{-3τ/2} (slowest if c ≠ a + b): it is below 1e-17 outside
    std::array<Node, last - first + 1> all;
    for (int i = first; i <= last; ++i) {
      const double v = 1 / (1 + std::exp(-step * i));
      const double rest = 1 / (1 + std::exp(step * i));
      all[static_cast<std::size_t>(i - first)] = {v, rest, step * std::pow(v * rest, 1.5)};
    }
    return all;
  }();
  return table;
}

}  // namespace

double sphere_hit_probability(SphereRadius inner, SphereRadius outer) {
  require_positive("sphere radius", inner.value);
  require_positive("sphere radius", outer.value);
  require_inside("inner sphere radius", inner.value, outer.value);
  const double ratio = inner.value / outer.value;
  return ratio * ratio;
}

double disc_hit_probability(DiscRadius disc, SphereRadius outer) {
  require_positive("disc radius", disc.value);
  require_positive("sphere radius", outer.value);
  require_inside("disc radius", disc.value, outer.value);
  const double ratio = disc.value / outer.value;
  return ratio * ratio / 2;
}

double crossing_probability(const Valid<Workload>& workload, double volume, double area) {
  require_non_negative("volume of the body", volume);
  require_non_negative("surface area of the body", area);
  return at_density(static_cast<double>(uniform_crossing(workload, volume, area)), workload.ray_density);
}

double at_density(double probability, double density) {
  return density == 1 ? probability : density * probability / (1 + (density - 1) * probability);
}

double expected_hits(const Valid<Workload>& workload) {
  const long double d = workload.disc_radius;
  const long double faces = workload.front_facing ? 1 : 2;
  return saturated(workload.ray_density * workload.hit_ratio * workload.rays *
                   (workload.samples * uniform_crossing(workload, 0, faces * exact_pi * d * d)));
}

double both_hit_share(double a, double b, double c) {
  require_positive("sphere radius", a);
  require_positive("sphere radius", b);
  require_non_negative("distance of the centres", c);
  const Range range = range_of(a, b, c);
  const long double nested = b <= a ? 1 : static_cast<long double>(a) / b * a / b;
  if (range.q_less_p <= 0) return static_cast<double>(nested);
  const auto over_q = [&](long double length) { return static_cast<double>(length / range.q); };
  const auto over_f = [&](long double length) { return static_cast<double>(length / range.f); };
  const double p = over_q(range.p);
  const double width = over_q(range.q_less_p);
  const double end = over_f(range.f_less_q);
  const double fall = over_f(range.q_less_p);
  const double q = over_f(range.q);
  double sum = 0;
  for (const Node& node : nodes()) {
    const double s = p + width * node.v;
    const double chord = (1 + s) * (s + p);
    const double cosine = (end + fall * node.rest) * (1 + s * q);  // 1 - (s q)²
    sum += node.weight * (range.meet ? std::sqrt(chord * cosine) / s : std::sqrt(chord) * s / (1 + std::sqrt(cosine)));
  }
  const long double scale = range.q_less_p / b * (range.q_less_p / b) / exact_pi;
  if (range.meet) return static_cast<double>(nested - scale * (range.f / range.q) * sum);
  return static_cast<double>(scale * (range.q / range.f) * (range.q / range.f) * sum);
}

}  // namespace detp::model
