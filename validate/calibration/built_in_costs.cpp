#include "built_in_costs.hpp"

#include <span>

namespace detp::validate {
namespace {

/// Costs in nanoseconds by symbol, as `detp calibrate` prints them. Costs that are not named are 0.
struct Nanoseconds {
  double t = 0, u = 0, w = 0, v = 0, n = 0, c = 0, b = 0, p = 0, g = 0, s = 0, r = 0, l = 0, h = 0, i = 0, m = 0, a = 0;

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
            .far = nano * m,
            .start = nano * a};
  }
};

struct BuiltIn {
  Technique technique;
  Nanoseconds units;
  ThreadCosts threads = {};
};

// The costs of the plain engine and of threads are from one run on a machine that other programs used, too. Threads are
// from its two cores, so that the costs of more threads are extrapolated. Too few runs of brute force by the simd engine were
// divided: it has the costs of threads of the sphere cache.
constexpr BuiltIn of_simd[] = {{Technique::brute_force,
                                {.u = 0.438, .l = 21.8, .i = 5.87, .m = 0.715, .a = 3.69e+03},
                                {.serial_preparing = 1, .serial_search = 0.0519, .start = 1.09e-05}},
                               {Technique::sphere_cache,
                                {.t = 0.487, .u = 0.401, .c = 0.916, .r = 111, .l = 184, .i = 5.23, .m = 87.8},
                                {.serial_preparing = 1, .serial_search = 0.0519, .start = 1.09e-05}},
                               {Technique::cell_spheres,
                                {.t = 0.62, .u = 0.494, .s = 68.1, .r = 133, .l = 233, .i = 10.2, .m = 205},
                                {.serial_preparing = 1, .serial_search = 0.146, .start = 1.11e-05}},
                               {Technique::box_tree,
                                {.t = 0.554,
                                 .u = 0.449,
                                 .c = 1.33,
                                 .p = 44.3,
                                 .g = 57.6,
                                 .r = 37.4,
                                 .l = 15.3,
                                 .i = 4.48,
                                 .m = 7.5,
                                 .a = 3.62e+03},
                                {.serial_preparing = 0.236, .serial_search = 0.411, .start = 5.31e-05}}};

constexpr BuiltIn of_plain[] = {
    {Technique::brute_force,
     {.u = 5.67, .h = 100, .m = 0.607},
     {.serial_preparing = 1, .serial_search = 0.0828, .start = 3.8e-05}},
    {Technique::sphere_cache, {.t = 6.43, .u = 5.07, .c = 30.2, .s = 85.3, .r = 9.8, .h = 62.1, .m = 91.9}},
    {Technique::cell_spheres, {.t = 15.4, .u = 7.31, .s = 79.7, .r = 72.7, .h = 89.3, .m = 79.5}},
    {Technique::box_tree,
     {.t = 12.7, .u = 5.74, .c = 22.4, .p = 71.6, .g = 90.4, .l = 3.08, .h = 94.7, .i = 13.5, .m = 19.9},
     {.serial_preparing = 0.236, .serial_search = 1, .start = 5.31e-05}}};

/// Of techniques without a simd engine.
constexpr BuiltIn of_both[] = {
    {Technique::sphere_tree, {.t = 7.32, .u = 3.86, .c = 4.57, .g = 163, .s = 118, .h = 73.7, .m = 22.5}},
    {Technique::octree,
     {.w = 3.07, .n = 74.6, .b = 98.1, .h = 97, .m = 49.9},
     {.serial_preparing = 1, .serial_search = 0.0202, .start = 5e-05}},
    {Technique::grid,
     {.w = 3.77, .v = 34.8, .b = 92.3, .h = 148, .i = 4.54, .m = 115},
     {.serial_preparing = 1, .serial_search = 0.224, .start = 0}},
    {Technique::bsp,
     {.w = 2.78, .n = 42.3, .b = 46.7, .h = 110, .m = 7.67},
     {.serial_preparing = 1, .serial_search = 0.315, .start = 0}},
    {Technique::bvh,
     {.b = 292, .h = 155, .i = 101, .m = 1.77, .a = 3.18e+04},
     {.serial_preparing = 1, .serial_search = 0.237, .start = 2.89e-05}},
    {Technique::ray_map, {.w = 0.564, .n = 43.6, .c = 36.3, .h = 51, .m = 14.5}}};

}  // namespace

CostTable built_in_unit_costs(Engine engine) {
  CostTable costs;
  costs.engine = engine;
  const auto set = [&](std::span<const BuiltIn> built_in) {
    for (const BuiltIn& one : built_in) {
      costs[one.technique] = one.units.seconds();
      costs.threads_of(one.technique) = one.threads;
    }
  };
  set(of_both);
  set(of_plain);
  costs[Technique::sphere_cache_published] = costs[Technique::sphere_cache];  // always plain
  if (engine == Engine::simd) set(of_simd);
  return costs;
}

}  // namespace detp::validate
