#include "built_in_costs.hpp"

#include <span>

namespace detp::validate {
namespace {

/// Costs in nanoseconds by symbol, as `detp calibrate` prints them. Costs that are not named are 0.
struct Nanoseconds {
  double t = 0, u = 0, w = 0, v = 0, n = 0, c = 0, b = 0, p = 0, g = 0, s = 0, r = 0, l = 0, h = 0, i = 0, e = 0, m = 0,
         o = 0, f = 0, y = 0, a = 0;

  [[nodiscard]] UnitCosts seconds() const {
    constexpr double nano = 1e-9;
    return {.cull_test = nano * t,
            .disc_test = nano * u,
            .index_test = nano * w,
            .step = nano * v,
            .node = nano * n,
            .listed = nano * c,
            .placement = nano * b,
            .leaf = nano * p,
            .make = nano * g,
            .sort = nano * s,
            .cull = nano * r,
            .visit = nano * l,
            .hit = nano * h,
            .ray = nano * i,
            .ends = nano * e,
            .far = nano * m,
            .uncached = nano * o,
            .long_test = nano * f,
            .far_ray = nano * y,
            .start = nano * a};
  }
};

struct BuiltIn {
  Technique technique;
  Nanoseconds units;
  ThreadCosts threads = {};
};

// Unit costs: one fit to the runs of four calibrations of 60 s with different seeds, on a machine with two cores; but o was
// measured on another machine, and scaled as p. f and y lie between those of two machines (Zen 3 with AVX2, Emerald Rapids with
// AVX-512), scaled as t and i. The simd engine of techniques that trace rays one by one: those of the plain engine times the
// ratio of both engines' costs in one run of detp calibrate --seconds 60 on an AMD EPYC (Zen 3, AVX2). Costs of threads: from
// earlier single runs of detp calibrate; those of more than two threads are extrapolated.
constexpr BuiltIn of_simd[] = {
    {Technique::brute_force,
     {.u = 0.628, .l = 27.2, .i = 5.21, .e = 0.223, .m = 6.04, .y = 11, .a = 9.34e+03},
     {.serial_preparing = 1, .serial_search = 0.0519, .start = 1.09e-05}},
    {Technique::sphere_cache,
     {.t = 0.643,
      .u = 0.674,
      .c = 1.33,
      .s = 100,
      .r = 180,
      .l = 220,
      .i = 7.92,
      .e = 0.347,
      .m = 238,
      .f = 1,
      .y = 11},
     {.serial_preparing = 1, .serial_search = 0, .start = 3.31e-06}},
    {Technique::cell_spheres,
     {.t = 1.19,
      .u = 1,
      .s = 98.1,
      .r = 225,
      .l = 347,
      .i = 5.61,
      .e = 0.205,
      .m = 24.6,
      .f = 1,
      .y = 11,
      .a = 5.2e+03},
     {.serial_preparing = 1, .serial_search = 0, .start = 3.76e-06}},
    {Technique::box_tree,
     {.t = 0.618,
      .u = 0.56,
      .c = 2.12,
      .p = 70.5,
      .g = 78,
      .r = 70.4,
      .l = 18.5,
      .i = 6.95,
      .e = 0.231,
      .m = 11.2,
      .o = 18.5,
      .f = 1,
      .y = 11,
      .a = 1.21e+04},
     {.serial_preparing = 0.333, .serial_search = 0.29, .start = 8.82e-05}},
    {Technique::octree,
     {.w = 1.28, .n = 131, .b = 136, .h = 36.8, .i = 37, .e = 0.54, .m = 92.6},
     {.serial_preparing = 1, .serial_search = 0.18, .start = 1.1e-05}},
    {Technique::grid,
     {.w = 1.41, .v = 45, .b = 133, .h = 107, .i = 31.6, .e = 0.61, .m = 143},
     {.serial_preparing = 1, .serial_search = 0.17, .start = 2.18e-05}},
    {Technique::bsp,
     {.w = 2.8, .n = 26.2, .b = 59.9, .h = 35.5, .e = 0.56},
     {.serial_preparing = 1, .serial_search = 0.25, .start = 0}},
    {Technique::bvh,
     {.w = 3.24, .b = 411, .h = 184, .i = 97.8, .e = 41, .a = 7.28e+04},
     {.serial_preparing = 0.00424, .serial_search = 0.177, .start = 2.14e-05}},
    {Technique::ray_map, {.w = 3.32, .n = 16.5, .c = 23.7, .l = 2.86, .h = 49, .e = 0.144, .m = 1.02}}};

constexpr BuiltIn of_plain[] = {
    {Technique::brute_force,
     {.u = 5.78, .h = 116, .e = 0.547},
     {.serial_preparing = 1, .serial_search = 0, .start = 1.94e-05}},
    {Technique::sphere_cache,
     {.t = 4.62, .u = 3.78, .c = 30.5, .s = 80.5, .r = 23.1, .l = 57.6, .h = 121, .e = 6.9, .m = 21.2}},
    {Technique::cell_spheres, {.t = 15.2, .u = 5.89, .s = 78.3, .r = 37.7, .l = 75.7, .h = 106, .e = 3.39, .m = 21.2}},
    {Technique::box_tree,
     {.t = 12.5, .u = 6.11, .c = 30.9, .p = 72.1, .g = 91.5, .h = 104, .e = 0.687, .m = 8.81, .o = 26, .a = 333},
     {.serial_preparing = 0.236, .serial_search = 1, .start = 5.31e-05}},
    {Technique::octree,
     {.w = 5.77, .n = 131, .b = 136, .h = 127, .e = 0.792, .m = 92.6},
     {.serial_preparing = 1, .serial_search = 0.0965, .start = 1.1e-05}},
    {Technique::grid,
     {.w = 5.74, .v = 45, .b = 133, .h = 288, .i = 31.6, .e = 1.35, .m = 143},
     {.serial_preparing = 1, .serial_search = 0.0869, .start = 2.18e-05}},
    {Technique::bsp,
     {.w = 6.52, .n = 37.4, .b = 59.9, .h = 189, .e = 1.01},
     {.serial_preparing = 1, .serial_search = 0.198, .start = 0}},
    {Technique::sphere_tree, {.t = 10.4, .u = 5.71, .c = 12, .g = 238, .s = 156, .h = 114, .e = 2.85, .m = 23}},
    {Technique::bvh,
     {.w = 3.24, .b = 411, .h = 234, .i = 97.8, .e = 52.2, .a = 7.28e+04},
     {.serial_preparing = 0.00424, .serial_search = 0.177, .start = 2.14e-05}},
    {Technique::ray_map, {.w = 6.71, .n = 26.2, .c = 56.9, .h = 95.1, .e = 0.301, .m = 2.09}}};

}  // namespace

CostTable built_in_unit_costs(Engine engine) {
  CostTable costs;
  costs.engine = engine;
  costs.relative_errors.fill(0.5);  // two standard errors are a factor of two
  const auto set = [&](std::span<const BuiltIn> built_in) {
    for (const BuiltIn& one : built_in) {
      costs[one.technique] = one.units.seconds();
      costs.threads_of(one.technique) = one.threads;
    }
  };
  set(of_plain);
  costs[Technique::sphere_cache_published] = costs[Technique::sphere_cache];  // always plain
  if (engine == Engine::simd) set(of_simd);
  return costs;
}

}  // namespace detp::validate
