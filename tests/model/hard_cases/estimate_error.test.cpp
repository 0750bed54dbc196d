#include <algorithm>

#include "detp/model/accuracy/estimate_error.hpp"
#include "detp/model/accuracy/scene_error.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

void compare_uniform(double rays, double deviation, double disc, double outer, Ledger& ledger) {
  const auto inputs = [&] {
    return fmt::format("n_R {:g}, deviation {:a}, d {:a}, r0 {:a}", rays, deviation, disc, outer);
  };
  const Exact p = Exact{disc} / outer * (Exact{disc} / outer) / 2;
  ledger.compare("deviation, uniform field", model::uniform_field_deviation(rays, {disc}, {outer}),
                 support::root_of((1 - p) / (rays * p)), inputs);
  ledger.compare("rays for a deviation", model::rays_for_deviation(deviation, {disc}, {outer}),
                 (1 - p) / (p * deviation * deviation), inputs);
}

void compare_smooth(double f, double laplacian, double photons, double radius, double error, Ledger& ledger) {
  const auto inputs = [&] {
    return fmt::format("f {:a}, Laplacian {:a}, n {:a}, h {:a}, error {:a}", f, laplacian, photons, radius, error);
  };
  const model::SmoothDensity density{.value = f, .laplacian = laplacian};
  const model::DensityError found = model::density_error(density, photons, radius);
  const Exact square = Exact{radius} * radius;
  const Exact variance = f / (photons * support::pi() * square);
  const Exact bias = square * laplacian / 8;
  ledger.compare("variance", found.variance, variance, inputs);
  ledger.compare("bias", found.bias, bias, inputs);
  ledger.compare("mean square error", found.mean_square(), variance + bias * bias, inputs);
  const Exact curvature = abs(Exact{laplacian});
  ledger.compare("best radius", model::best_density_radius(density, photons),
                 support::cube_root(support::root_of(Exact{32} * f / (photons * support::pi())) / curvature), inputs);
  static const Exact scale = sqrt(pow(Exact{3} / 2, 3) / 32) / support::pi();
  ledger.compare("photons for an error", model::photons_for_error(density, error),
                 scale * curvature / (Exact{f} * f * error * error * error), inputs);
}

void compare_random_errors(Draw& draw, Ledger& ledger) {
  const double outer = draw.anywhere();
  const double disc = std::max(outer * draw.log_uniform(1e-300, 1), 5e-324);
  compare_uniform(draw.rays_or_samples(), draw.factor(), std::min(disc, outer), outer, ledger);
  const double sign = draw.whole(0, 1) == 0 ? -1 : 1;
  compare_smooth(draw.factor(), sign * draw.factor(), draw.factor(), draw.factor(), draw.factor(), ledger);
}

void compare_edge_errors(Ledger& ledger) {
  for (const double outer : {1e-300, 1.0, 1.79e308})
    for (const double share : {5e-324, 1e-300, 1e-160, 0.5, 1 - 0x1p-53, 1.0})
      for (const double deviation : {5e-324, 1e-3, 1.79e308})
        for (const double rays : {1.0, 1e18})
          compare_uniform(rays, deviation, std::max(share * outer, 5e-324), outer, ledger);
  const auto extremes = {5e-324, 1.0, 1.79e308};
  for (const double f : extremes)
    for (const double laplacian : {-1.79e308, -5e-324, 5e-324, 1.0, 1.79e308})
      for (const double photons : extremes)
        for (const double radius : extremes)
          for (const double error : extremes) compare_smooth(f, laplacian, photons, radius, error, ledger);
}

struct SceneErrorInputs {
  double mean, mean_square, photon, radius, clumping, area, reflected, walls, edges, laplacian;
};

void compare_scene_error(const SceneErrorInputs& x, Ledger& ledger) {
  const auto inputs = [&] {
    return fmt::format("mean {:a}, mean square {:a}, photon {:a}, d {:a}, c {:a}, A {:a}, rho {:a}, n {:g}, L {:a}",
                       x.mean, x.mean_square, x.photon, x.radius, x.clumping, x.area, x.reflected, x.walls, x.edges);
  };
  const model::SceneLight light{x.mean, x.mean_square};
  const Exact disc = support::pi() * x.radius * x.radius;
  ledger.compare("noise of discs", model::disc_noise_squared(light, x.photon, x.radius, x.clumping),
                 Exact{x.clumping} * x.photon * x.mean / (disc * x.mean_square), inputs);
  ledger.compare("noise of triangle hits", model::triangle_noise_squared(light, x.photon, x.area, x.clumping),
                 Exact{x.clumping} * x.photon * x.mean / (9 * Exact{x.area} * x.mean_square), inputs);
  if (disc <= Exact{x.area}) {
    const Exact rho = x.reflected;
    const Exact later = rho / (1 - rho) - rho / (1 + rho / (Exact{x.walls} - 1));
    ledger.compare("clumping", model::room_clumping(x.reflected, x.radius, x.area, x.walls),
                   1 + 2 * disc / x.area * later, inputs);
  }
  static const Exact integral = (2 * support::pi() / 3 - Exact{64} / 45) / (support::pi() * support::pi());
  ledger.compare("edges", model::bias_of_edges(x.edges, x.area), integral * x.edges / x.area, inputs);
  ledger.compare("curvature", model::bias_of_curvature(light, x.laplacian), Exact{x.laplacian} / 64 / x.mean_square,
                 inputs);
  const Exact d = x.radius;
  ledger.compare("bias", model::bias_squared({x.mean, x.edges, x.laplacian}, x.radius),
                 x.mean + x.edges * d + x.laplacian * d * d * d * d, inputs);
}

void compare_random_scene_error(Draw& draw, Ledger& ledger) {
  compare_scene_error({draw.factor(), draw.factor(), draw.factor(), draw.factor(), std::max(1.0, draw.factor()),
                       draw.factor(), std::min(1 - 0x1p-53, draw.log_uniform(1e-300, 1)),
                       std::max(2.0, draw.rays_or_samples()), draw.factor(), draw.factor()},
                      ledger);
}

void compare_limits_of_scene_error(Ledger& ledger) {
  for (const double extreme : {5e-324, 1.0, 1.79e308})
    for (const double radius : {5e-324, 1e-160, 1.0, 1.79e308})
      for (const double reflected : {0.0, 5e-324, 0.5, 1 - 0x1p-53})
        for (const double walls : {2.0, 6.0, 1e18})
          compare_scene_error({extreme, 1, 1, radius, 1, 1.79e308, reflected, walls, extreme, extreme}, ledger);
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of the estimate's error: every argument up to both limits of the doubles") {
    Ledger ledger = on_random_inputs(7, few, compare_random_errors);
    compare_edge_errors(ledger);
    require_right(ledger);
  }

  TEST_CASE("hard cases of errors over a scene: every argument up to both limits of the doubles") {
    Ledger ledger = on_random_inputs(8, few, compare_random_scene_error);
    compare_limits_of_scene_error(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("the estimate's error") { require_right_and_print(on_random_inputs(7, many, compare_random_errors)); }

  TEST_CASE("errors over a scene") { require_right_and_print(on_random_inputs(8, many, compare_random_scene_error)); }
}
