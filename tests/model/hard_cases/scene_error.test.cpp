#include "detp/model/accuracy/scene_error.hpp"

#include <algorithm>

#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

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
  TEST_CASE("hard cases of errors over a scene: every argument up to both limits of the doubles") {
    Ledger ledger = on_random_inputs(8, few, compare_random_scene_error);
    compare_limits_of_scene_error(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("errors over a scene") { require_right_and_print(on_random_inputs(8, many, compare_random_scene_error)); }
}
