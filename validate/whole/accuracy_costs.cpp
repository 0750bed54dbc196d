#include "accuracy_costs.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/base/threads.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibration_file.hpp"

namespace detp::validate {
namespace {

constexpr double measured_threads = 2;
constexpr double measured_ratio = 1.14;  // machine_ratio() where the unit costs were measured

double log_of(double count) { return std::log2(std::max(2.0, count)); }

/// Stored costs of the plain box tree over the built-in ones: above 1 on a slower machine. Where nothing is stored, measured_ratio.
double machine_ratio() {
  const auto stored = stored_calibration();
  if (!stored) return measured_ratio;
  const UnitCosts here = stored->plain[Technique::box_tree];
  const UnitCosts usual = built_in_unit_costs(Engine::plain)[Technique::box_tree];
  const double ratio = std::sqrt(here.cull_test / usual.cull_test * here.disc_test / usual.disc_test);
  return ratio > 0 && std::isfinite(ratio) ? ratio : measured_ratio;
}

}  // namespace

double GrowingSeconds::rays_in(double seconds) const {
  const double left = seconds - fixed;
  if (left <= 0) return 1;
  // of a x² + b x = left, in a form without cancellation
  const double root = std::sqrt(per_ray * per_ray + 4 * per_ray_squared * left);
  return std::max(1.0, 2 * left / (per_ray + root));
}

GrowingSeconds operator+(const GrowingSeconds& a, const GrowingSeconds& b) {
  return {a.fixed + b.fixed, a.per_ray + b.per_ray, a.per_ray_squared + b.per_ray_squared};
}

AccuracyCosts::AccuracyCosts(std::size_t triangles, int threads)
    : triangles_(static_cast<double>(triangles)), unit_(0), unit_of_one_(1e-6 * machine_ratio() / measured_ratio) {
  unit_ = unit_of_one_ * measured_threads / sim::useful_threads(threads);
}

double AccuracyCosts::caster() const { return unit_ * 0.6 * triangles_; }

GrowingSeconds AccuracyCosts::trace() const { return {caster(), unit_ * 0.027 * log_of(triangles_)}; }

GrowingSeconds AccuracyCosts::lines() const { return {0, unit_ * 0.03}; }

double AccuracyCosts::read(double text_bytes, double binary_bytes, double discs) const {
  return unit_of_one_ * (1.7 * triangles_ + 0.3 * discs + 0.003 * text_bytes + 0.001 * binary_bytes);
}

double AccuracyCosts::path(double casts) const { return unit_ * (0.1 + 0.026 * log_of(triangles_)) * casts; }

double AccuracyCosts::surfaces(sim::Estimator estimator) const {
  return sim::record_of(estimator).needs_mesh() ? unit_ * 0.55 * triangles_ : 0;
}

GrowingSeconds AccuracyCosts::estimate(sim::Estimator estimator, double samples, const SettingCounts& counts) const {
  using enum sim::Estimator;
  const double of_hits = counts.hits_per_ray;
  const double r = counts.radius_over_edge;
  GrowingSeconds found;
  switch (estimator) {
    case disc:
      found = {0.08 * samples, 0.0066 * log_of(samples) + 0.0085 * of_hits};
      break;
    case variable_radius:  // four searches, of which one has most rays
      found = {0.3 * samples, 0.34 + 0.0105 * of_hits};
      break;
    case nearest:  // of k neighbours each is put in its place among those before
      found = {0, 1.2 + 0.095 * samples * counts.nearest_per_ray,
               0.00027 * samples * counts.nearest_per_ray * counts.nearest_per_ray};
      break;
    case area_corrected:  // measures the surfaces within each sphere
      found = {(1.2 + 3.3 * r + 1.2 * r * r) * samples, 1.1 + 0.15 * of_hits};
      break;
    case triangle_hits:
      found = {1.1 * samples, 0.08};
      break;
    case gather:
      break;
  }
  return {surfaces(estimator) + unit_ * found.fixed, unit_ * found.per_ray, unit_ * found.per_ray_squared};
}

}  // namespace detp::validate
