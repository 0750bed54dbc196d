#include "best_published_ratio.hpp"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/model/sphere_cache/step_pieces.hpp"

namespace detp::model::published {
namespace {

/// A function's value and its first two derivatives.
struct Jet {
  double value = 0;
  double slope = 0;
  double curvature = 0;

  /// Adds factor · e^{rate x}; `term` is its value.
  void add(double term, double rate) {
    value += term;
    slope += rate * term;
    curvature += rate * rate * term;
  }
};

/// T over x = ln Q on one part: `spheres` is k; the outer `sparse` spheres are rebuilt fewer than n_P times.
class ConvexPart {
 public:
  ConvexPart(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, std::int64_t spheres, std::int64_t sparse)
      : samples_(workload.samples),
        test_(costs.cull_test * workload.rays),
        disc_(costs.disc_test * workload.rays * workload.samples),
        spheres_(spheres),
        sparse_(std::min(sparse, spheres)) {}

  [[nodiscard]] Jet at(double x) const {
    const double q = std::exp(x);
    Jet jet;
    double power = test_ / (q * q);
    for (std::int64_t i = 1; i <= sparse_; ++i) jet.add(power /= q, -static_cast<double>(i + 2));
    power = test_ * samples_ * std::exp(2 * static_cast<double>(sparse_) * x);
    for (std::int64_t i = sparse_ + 1; i <= spheres_; ++i, power *= q * q)
      jet.add(power, 2.0 * static_cast<double>(i - 1));
    jet.add(disc_ * std::exp(2 * static_cast<double>(spheres_) * x), 2 * static_cast<double>(spheres_));
    return jet;
  }

  /// The x at which T is smallest on [low, high], if T' has different signs at the ends: Newton's method on T'.
  [[nodiscard]] double minimum(double low, double high) const {
    const auto slope = [&](double x) {
      const Jet jet = at(x);
      return std::pair(jet.slope, jet.curvature);
    };
    std::uintmax_t steps = 60;
    return boost::math::tools::newton_raphson_iterate(slope, (low + high) / 2, low, high, 46, steps);
  }

 private:
  double samples_;
  double test_;
  double disc_;
  std::int64_t spheres_;
  std::int64_t sparse_;
};

/// Keeps the smallest T found, and a lower bound for all parts that were skipped.
class Search {
 public:
  Search(const Valid<Workload>& workload, const Valid<UnitCosts>& costs) : workload_(workload), costs_(costs) {}

  void piece(std::int64_t spheres, double low, double high) {
    double left = std::log(low);
    for (const double kink : kinks(left, std::log(high))) {
      part(spheres, left, kink);
      left = kink;
    }
    part(spheres, left, std::log(high));
  }

  [[nodiscard]] BestRatio finish() const {
    BestRatio best = best_;
    if (best.spheres > 0) best.lower_bound = std::min(bound_ * (1 - 1e-12), best.time);
    return best;
  }

 private:
  /// ln Q at which m_J = n_P for some sphere J, between the two ends, in rising order.
  [[nodiscard]] std::vector<double> kinks(double left, double right) const {
    std::vector<double> all;
    const double third = -std::log(workload_.samples) / 3;
    if (third == 0) return all;
    for (double j = std::max(1.0, std::ceil(third / left)); third / j < right; ++j)
      if (third / j > left) all.push_back(third / j);
    return all;
  }

  void part(std::int64_t spheres, double left, double right) {
    const double middle = (left + right) / 2;
    const auto sparse = static_cast<std::int64_t>(std::log(workload_.samples) / (-3 * middle));
    const ConvexPart part(workload_, costs_, spheres, sparse);
    const Jet at_left = part.at(left);
    const Jet at_right = part.at(right);
    if (at_left.slope >= 0) return found(spheres, left, at_left.value);
    if (at_right.slope <= 0) return found(spheres, right, at_right.value);
    if (best_.spheres > 0 && tangents_meet(at_left, at_right, right - left) >= best_.time) return;
    const double x = part.minimum(left, right);
    const Jet jet = part.at(x);
    found(spheres, x, jet.value - std::abs(jet.slope) * (right - left));
  }

  /// A lower bound on T in a part, in which T is convex: the value where the tangents at the part's two ends meet.
  static double tangents_meet(const Jet& left, const Jet& right, double width) {
    const double along = (right.value - left.value - right.slope * width) / (left.slope - right.slope);
    return left.value + left.slope * along;
  }

  void found(std::int64_t spheres, double x, double bound) {
    const double ratio = std::exp(x);
    const double time = rebuild_time(workload_, {ratio}, spheres, costs_.cull_test) +
                        intersect_time(workload_, {ratio}, spheres, costs_.disc_test);
    bound_ = best_.spheres == 0 ? bound : std::min(bound_, bound);
    if (best_.spheres == 0 || time < best_.time) best_ = {ratio, spheres, time, 0};
  }

  const Valid<Workload>& workload_;
  const Valid<UnitCosts>& costs_;
  BestRatio best_;
  double bound_ = 0;
};

}  // namespace

BestRatio best_ratio(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, std::int64_t most_spheres) {
  const StepPieces pieces(workload);
  require_count("largest number of spheres", static_cast<double>(most_spheres), 1, 1e18);
  Search search(workload, costs);
  for (std::int64_t j = 1; j <= most_spheres && pieces.above(j - 1) < most_ratio; ++j) {
    const double low = std::max(pieces.above(j - 1), least_ratio);
    const double high = std::min(pieces.below(j), most_ratio);
    if (low < high) search.piece(j, low, high);
  }
  return search.finish();
}

std::int64_t best_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, RadiusRatio ratio) {
  const std::int64_t last = sphere_count(Form::published, ratio, {workload.disc_radius}, {workload.sphere_radius});
  const double q = ratio.value;
  const double share = costs.disc_test / costs.cull_test * (1 - q) * (1 + q);  // u (1 - Q²)/t
  if (last == 0 || costs.cull_test == 0 || share > 1) return last;
  const double paying = std::ceil(std::log(share * workload.samples) / (-3 * std::log(q))) - 1;
  return paying < static_cast<double>(last) ? static_cast<std::int64_t>(std::max(paying, 1.0)) : last;
}

}  // namespace detp::model::published
