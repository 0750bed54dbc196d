#include "best_ratio.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "predict.hpp"
#include "sphere_cache_published.hpp"
#include "sphere_count.hpp"

namespace detp::model {
namespace {

constexpr double least_ratio = 0.02;
constexpr double most_ratio = 0.98;

double corrected_time(const Workload& workload, const UnitCosts& costs, double ratio, std::int64_t k) {
  return price(predict(workload, {Technique::sphere_cache, SphereCacheParameters{ratio, k, SampleOrder::lebesgue}}),
               costs)
      .total();
}

double published_time(const Workload& workload, const UnitCosts& costs, double ratio, std::int64_t k) {
  return published::rebuild_time(workload, {ratio}, k, costs.sphere_test) +
         published::intersect_time(workload, {ratio}, k, costs.disc_test);
}

void check_spheres_pay(const Workload& workload) {
  check(workload);
  if (workload.disc_radius >= workload.sphere_radius)
    throw std::invalid_argument("the disc radius must be smaller than the sphere radius, or no sphere pays");
}

/// The best of a piece [low, high] with k spheres: its ends, and Brent's minimum around the best of a few points, for
/// the rebuild law goes up and down with log Q.
template <class Time>
void improve(BestRatio& best, double low, double high, std::int64_t k, const Time& time) {
  low = std::max(low, least_ratio);
  high = std::min(high, most_ratio);
  if (!(low < high)) return;
  const auto consider = [&](double ratio) {
    const double t = time(ratio, k);
    if (best.spheres == 0 || t < best.time) best = {ratio, k, t};
    return t;
  };
  constexpr int parts = 32;
  const double part = (high - low) / parts;
  int least = 0;
  double least_time = consider(low);
  for (int i = 1; i <= parts; ++i)
    if (const double t = consider(i < parts ? low + i * part : high); t < least_time) {
      least = i;
      least_time = t;
    }
  constexpr int bits = std::numeric_limits<double>::digits / 2;
  std::uintmax_t evaluations = 60;
  const double left = low + std::max(0, least - 1) * part;
  const double right = std::min(high, low + (least + 1) * part);
  consider(boost::math::tools::brent_find_minima([&](double q) { return time(q, k); }, left, right, bits, evaluations)
               .first);
}

/// The smallest double at or above Q_j for which the corrected k is still j.
double piece_start(const Workload& workload, std::int64_t j) {
  const DiscRadius d{workload.disc_radius};
  const SphereRadius r0{workload.sphere_radius};
  double q = step_ratio(j, d, r0);
  while (q < 1 && sphere_count(Form::corrected, {q}, d, r0) < j) q = std::nextafter(q, 1.0);
  return q;
}

}  // namespace

BestRatio best_ratio(Form form, const Workload& workload, const UnitCosts& costs, std::int64_t most_spheres) {
  check_spheres_pay(workload);
  require_count("largest number of spheres", static_cast<double>(most_spheres), 1, 1e18);
  BestRatio best;
  const auto time = [&](double q, std::int64_t k) {
    return form == Form::published ? published_time(workload, costs, q, k) : corrected_time(workload, costs, q, k);
  };
  // Corrected: k = j on [Q_j, Q_{j+1}).  Published: k = j on (Q_{j-1}, Q_j].
  for (std::int64_t j = 1; j <= most_spheres; ++j) {
    const std::int64_t first = form == Form::published ? j - 1 : j;
    double low = first == 0 ? least_ratio : piece_start(workload, first);
    if (form == Form::published && first > 0) low = std::nextafter(low, 1.0);  // past Q_{j-1}, even where it is a tie
    const double high = std::nextafter(piece_start(workload, first + 1), 0.0);
    improve(best, low, high, j, time);
  }
  return best;
}

BestRatio best_ratio_and_stop(const Workload& workload, const UnitCosts& costs, std::int64_t most_spheres) {
  check_spheres_pay(workload);
  require_count("largest number of spheres", static_cast<double>(most_spheres), 1, 1e18);
  BestRatio best;
  std::int64_t worse = 0;
  for (std::int64_t k = 1; k <= most_spheres && worse < 6; ++k) {
    const BestRatio before = best;
    improve(best, piece_start(workload, k), most_ratio, k,
            [&](double q, std::int64_t spheres) { return corrected_time(workload, costs, q, spheres); });
    worse = best.spheres == before.spheres && k > 1 ? worse + 1 : 0;
  }
  // Long pieces may hide a minimum that the short ones between the steps of k find.
  const BestRatio down_to_disc = best_ratio(Form::corrected, workload, costs, most_spheres);
  return down_to_disc.spheres > 0 && down_to_disc.time < best.time ? down_to_disc : best;
}

BestRatio best_stop(const Workload& workload, const UnitCosts& costs, RadiusRatio ratio) {
  check_spheres_pay(workload);
  constexpr std::int64_t most = 4096;
  const std::int64_t last = sphere_count(Form::corrected, ratio, {workload.disc_radius}, {workload.sphere_radius});
  BestRatio best{ratio.value, 1, corrected_time(workload, costs, ratio.value, 1)};
  for (std::int64_t k = 2; k <= std::min(last, most); ++k)
    if (const double t = corrected_time(workload, costs, ratio.value, k); t < best.time) best = {ratio.value, k, t};
  return best;
}

BestRatio best_ratio_for(const Workload& workload, const UnitCosts& costs, std::int64_t spheres) {
  check_spheres_pay(workload);
  BestRatio best;
  improve(best, piece_start(workload, spheres), most_ratio, spheres,
          [&](double q, std::int64_t k) { return corrected_time(workload, costs, q, k); });
  if (best.spheres == 0) best = {most_ratio, spheres, corrected_time(workload, costs, most_ratio, spheres)};
  return best;
}

}  // namespace detp::model
