#include <algorithm>
#include <cmath>

#include "detp/model/accuracy/estimate_error.hpp"
#include "detp/model/accuracy/scene_error.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/vocabulary/workload.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

/// ln(volume^(D - 2) area^(3 - D)); a side counts as at least a millionth of the longest.
Exact log_of_extent(const Workload& w) {
  if (w.sample_extent > 0) return support::log_of(w.sample_extent);
  const Exact sliver = Exact{1e-6} * scene_side(w);
  const Exact x = std::max<Exact>(w.box[0], sliver);
  const Exact y = std::max<Exact>(w.box[1], sliver);
  const Exact z = std::max<Exact>(w.box[2], sliver);
  const Exact weight = std::max(0.0, w.dimension - 2);
  return weight * support::log_of(x * y * z) + (1 - weight) * support::log_of(2 * (x * y + y * z + z * x));
}

void compare(const Workload& w, Ledger& ledger) {
  const auto inputs = [&] {
    return fmt::format("box {:a} {:a} {:a}, n_P {:g}, D {:a}, extent {:a}", w.box[0], w.box[1], w.box[2], w.samples,
                       w.dimension, w.sample_extent);
  };
  static const Exact half_root_of_3 = sqrt(Exact{3}) / 2;
  const Exact log_extent = log_of_extent(w);
  ledger.compare("extent of the samples", sample_extent(w), support::exp_of(log_extent), inputs);
  ledger.compare("distance of the samples", sample_distance(w),
                 support::exp_of((log_extent - support::log_of(w.samples)) / w.dimension), inputs);
  ledger.compare("radius around a cube", enclosing_radius(scene_side(w), w.disc_radius),
                 scene_side(w) * half_root_of_3 + w.disc_radius, inputs);
}

void compare_random_workloads(Draw& draw, Ledger& ledger) {
  Workload w = draw.workload();
  const std::int64_t kind = draw.whole(0, 3);
  w.dimension = kind == 0 ? 2 : kind == 1 ? 3 : draw.uniform(1, 3);
  if (draw.whole(0, 3) == 0) w.sample_extent = draw.anywhere();
  compare(w, ledger);
}

void compare_edge_workloads(Ledger& ledger) {
  for (const double side : {1e-90, 1.0, 1e90})
    for (const double flat : {0.0, 1e-6, 1.0})
      for (const double dimension :
           {1.0, std::nextafter(2.0, 1.0), 2.0, std::nextafter(2.0, 3.0), std::nextafter(3.0, 2.0), 3.0})
        for (const double samples : {1.0, 1e18})
          for (const double extent : {0.0, 5e-324, 1.79e308})
            compare({.rays = 1,
                     .samples = samples,
                     .disc_radius = 1e-300,
                     .sphere_radius = side,
                     .box = {side, side * flat, side * flat},
                     .dimension = dimension,
                     .sample_extent = extent},
                    ledger);
}

void compare_bodies(double body, double outer, Ledger& ledger) {
  const auto inputs = [&] { return fmt::format("radius or side {:a}, r0 {:a}", body, outer); };
  const Exact share = Exact{body} / outer;
  ledger.compare("P(sphere)", model::sphere_hit_probability({body}, {outer}), share * share, inputs);
  ledger.compare("P(disc)", model::disc_hit_probability({body}, {outer}), share * share / 2, inputs);
}

Exact crossing(const Workload& w, const Exact& volume, const Exact& area) {
  const Exact r0 = w.sphere_radius;
  Exact space = 1;
  for (const double side : w.box) space *= side + 2 * Exact{w.disc_radius};
  return std::min<Exact>(1, w.path_length > 0 ? Exact{(volume + w.path_length * area / 4) / space}
                                              : Exact{area / (4 * support::pi() * r0 * r0)});
}

void compare_workload(const Workload& w, double volume, double area, Ledger& ledger) {
  const auto inputs = [&] {
    return fmt::format("n_R {:g}, n_P {:g}, d {:a}, r0 {:a}, box {:a} {:a} {:a}, path {:a}, V {:a}, F {:a}", w.rays,
                       w.samples, w.disc_radius, w.sphere_radius, w.box[0], w.box[1], w.box[2], w.path_length, volume,
                       area);
  };
  const bool segments = w.path_length > 0;
  ledger.compare(segments ? "P(body), segments" : "P(body), lines", model::crossing_probability(w, volume, area),
                 crossing(w, volume, area), inputs);
  const Exact d = w.disc_radius;
  ledger.compare(segments ? "expected hits, segments" : "expected hits, lines", model::expected_hits(w),
                 Exact{w.rays} * w.samples * crossing(w, 0, 2 * support::pi() * d * d), inputs);
}

void compare_random_lines(Draw& draw, Ledger& ledger) {
  const double outer = draw.anywhere();
  compare_bodies(std::max(outer * draw.log_uniform(1e-300, 1.15), 5e-324), outer * 1.16, ledger);
  Workload w = draw.workload();
  const double r0 = w.sphere_radius;
  if (draw.whole(0, 1) == 1) w.path_length = draw.whole(0, 3) == 0 ? draw.anywhere() : r0 * draw.log_uniform(1e-12, 2);
  const bool like_scene = draw.whole(0, 3) > 0;
  compare_workload(w, like_scene ? r0 * r0 * r0 * draw.log_uniform(1e-30, 1) : draw.anywhere(),
                   like_scene ? r0 * r0 * draw.log_uniform(1e-30, 10) : draw.anywhere(), ledger);
}

void compare_edge_lines(Ledger& ledger) {
  for (const double outer : {1e-300, 1.0, 1.7e308})
    for (const double share : {5e-324, 1e-300, 1e-160, 1e-154, 0.5, 0.8})
      compare_bodies(std::max(share * outer, 5e-324), outer, ledger);
  for (const double scale : {1e-90, 1.0, 1e90})
    for (const double disc : {5e-324, 1e-300, 1e-160, 0.01 * scale, scale, 1e3 * scale, 1.7e308})
      for (const double path : {0.0, 5e-324, 1e-300, scale, 1.7e308})
        for (const double flat : {0.0, 1.0})
          for (const double body : {0.0, 5e-324, 1.7e308})
            compare_workload({.rays = 1e18,
                              .samples = 1e18,
                              .disc_radius = disc,
                              .sphere_radius = scale,
                              .box = {scale, flat * scale, flat * scale},
                              .path_length = path},
                             body, body, ledger);
}

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
  TEST_CASE("hard cases of a workload: flat boxes at both limits of the scale, D next to 2 and 3, any extent") {
    Ledger ledger = on_random_inputs(10, few, compare_random_workloads);
    compare_edge_workloads(ledger);
    require_right(ledger);
  }

  TEST_CASE("hard cases of line measures: squares that over- or underflow, flat boxes, long paths") {
    Ledger ledger = on_random_inputs(4, few, compare_random_lines);
    compare_edge_lines(ledger);
    require_right(ledger);
  }

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
  TEST_CASE("workload") { require_right_and_print(on_random_inputs(10, many, compare_random_workloads)); }

  TEST_CASE("line measures") { require_right_and_print(on_random_inputs(4, many, compare_random_lines)); }

  TEST_CASE("the estimate's error") { require_right_and_print(on_random_inputs(7, many, compare_random_errors)); }

  TEST_CASE("errors over a scene") { require_right_and_print(on_random_inputs(8, many, compare_random_scene_error)); }
}
