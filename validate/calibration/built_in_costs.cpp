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

constexpr BuiltIn of_simd[] = {{Technique::brute_force,
                                {.u = 0.438, .l = 21.8, .i = 5.87, .m = 0.715, .a = 3.69e+03},
                                {.serial_preparing = 1, .serial_search = 0.1, .start = 2e-05}},
                               {Technique::sphere_cache,
                                {.t = 0.487, .u = 0.401, .c = 0.916, .r = 111, .l = 184, .i = 5.23, .m = 87.8},
                                {.serial_preparing = 1, .serial_search = 0.1, .start = 2e-05}},
                               {Technique::cell_spheres,
                                {.t = 0.62, .u = 0.494, .s = 68.1, .r = 133, .l = 233, .i = 10.2, .m = 205},
                                {.serial_preparing = 1, .serial_search = 0.1, .start = 2e-05}},
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
                                {.serial_preparing = 0.5, .serial_search = 0.1, .start = 2e-05}}};

constexpr BuiltIn of_plain[] = {
    {Technique::brute_force,
     {.u = 4.38, .l = 21.8, .i = 5.87, .m = 0.715, .a = 3.69e+03},
     {.serial_preparing = 1, .serial_search = 0.1, .start = 2e-05}},
    {Technique::sphere_cache, {.t = 4.87, .u = 4.01, .c = 9.16, .r = 111, .l = 184, .i = 5.23, .m = 87.8}},
    {Technique::cell_spheres, {.t = 6.2, .u = 4.94, .s = 68.1, .r = 133, .l = 233, .i = 10.2, .m = 205}},
    {Technique::box_tree,
     {.t = 5.54,
      .u = 4.49,
      .c = 13.3,
      .p = 44.3,
      .g = 57.6,
      .r = 37.4,
      .l = 15.3,
      .i = 4.48,
      .m = 7.5,
      .a = 3.62e+03}}};

/// Of techniques without a simd engine.
constexpr BuiltIn of_both[] = {
    {Technique::sphere_tree, {.t = 7.32, .u = 3.86, .c = 4.57, .g = 163, .s = 118, .h = 73.7, .m = 22.5}},
    {Technique::octree,
     {.w = 3.07, .n = 74.6, .b = 98.1, .h = 97, .m = 49.9},
     {.serial_preparing = 1, .serial_search = 0.1, .start = 2e-05}},
    {Technique::grid,
     {.w = 3.77, .v = 34.8, .b = 92.3, .h = 148, .i = 4.54, .m = 115},
     {.serial_preparing = 1, .serial_search = 0.1, .start = 2e-05}},
    {Technique::bsp,
     {.w = 2.78, .n = 42.3, .b = 46.7, .h = 110, .m = 7.67},
     {.serial_preparing = 1, .serial_search = 0.1, .start = 2e-05}},
    {Technique::bvh,
     {.b = 292, .h = 155, .i = 101, .m = 1.77, .a = 3.18e+04},
     {.serial_preparing = 1, .serial_search = 0.1, .start = 2e-05}},
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
