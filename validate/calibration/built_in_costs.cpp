#include "built_in_costs.hpp"

#include <span>

namespace detp::validate {
namespace {

/// Costs in nanoseconds by symbol, as `detp calibrate` prints them. Costs that are not named are 0.
struct Nanoseconds {
  double t = 0, u = 0, w = 0, v = 0, n = 0, c = 0, b = 0, p = 0, g = 0, s = 0, r = 0, l = 0, h = 0, i = 0, e = 0, m = 0,
         a = 0;

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
            .start = nano * a};
  }
};

struct BuiltIn {
  Technique technique;
  Nanoseconds units;
  ThreadCosts threads = {};
};

// All from one run of detp calibrate on a machine with two cores; left-out workloads were 15 % off in the median. The costs of
// more than two threads are extrapolated. In that run, too few runs of brute force by the simd engine, and of box trees by the
// plain engine, were divided among threads: these costs of threads are from an earlier run.
constexpr BuiltIn of_simd[] = {
    {Technique::brute_force,
     {.u = 0.495, .l = 14.9, .h = 6.62, .i = 4.86, .e = 0.2, .m = 3.23, .a = 9.74e+03},
     {.serial_preparing = 1, .serial_search = 0.0519, .start = 1.09e-05}},
    {Technique::sphere_cache,
     {.t = 0.403, .u = 1.12, .c = 1.27, .r = 171, .l = 173, .e = 0.351, .m = 377, .a = 1.53e+04},
     {.serial_preparing = 1, .serial_search = 0, .start = 3.31e-06}},
    {Technique::cell_spheres,
     {.t = 0.731, .u = 0.511, .r = 218, .l = 328, .i = 7.69, .e = 0.193, .a = 1.94e+04},
     {.serial_preparing = 1, .serial_search = 0, .start = 3.76e-06}},
    {Technique::box_tree,
     {.t = 0.605,
      .u = 0.474,
      .c = 1.43,
      .p = 53.4,
      .g = 69.8,
      .r = 35,
      .l = 17.9,
      .h = 0.633,
      .i = 2.36,
      .e = 0.271,
      .m = 1.73,
      .a = 1.6e+04},
     {.serial_preparing = 0.333, .serial_search = 0.29, .start = 8.82e-05}}};

constexpr BuiltIn of_plain[] = {
    {Technique::brute_force,
     {.u = 4.25, .h = 62.2, .i = 41.2, .a = 1.34e+04},
     {.serial_preparing = 1, .serial_search = 0, .start = 1.94e-05}},
    {Technique::sphere_cache, {.t = 5.59, .u = 4.22, .c = 28.9, .s = 71.4, .r = 14.9, .h = 88.3, .e = 5.1, .m = 24.2}},
    {Technique::cell_spheres, {.t = 12.8, .u = 5.13, .s = 71.7, .r = 123, .h = 155, .e = 3.42, .m = 24.6}},
    {Technique::box_tree,
     {.t = 8.72,
      .u = 5,
      .c = 21.7,
      .p = 52.8,
      .g = 80,
      .l = 2.34,
      .h = 106,
      .i = 5.24,
      .e = 0.495,
      .m = 3.27,
      .a = 1.12e+04},
     {.serial_preparing = 0.236, .serial_search = 1, .start = 5.31e-05}}};

/// Of techniques without a simd engine.
constexpr BuiltIn of_both[] = {
    {Technique::sphere_tree,
     {.t = 7.43, .u = 4.24, .c = 12.7, .g = 220, .s = 136, .h = 120, .i = 30.8, .e = 1.91, .m = 8.84}},
    {Technique::octree,
     {.w = 4.28, .n = 108, .b = 119, .h = 274, .e = 0.622, .m = 51.1, .a = 7.64e+03},
     {.serial_preparing = 1, .serial_search = 0.0965, .start = 1.1e-05}},
    {Technique::grid,
     {.w = 4.73, .v = 36.6, .b = 113, .h = 199, .i = 34, .e = 1.13, .m = 89.1, .a = 2.46e+03},
     {.serial_preparing = 1, .serial_search = 0.0869, .start = 2.18e-05}},
    {Technique::bsp,
     {.w = 4.05, .n = 37.3, .b = 46.4, .h = 159, .e = 2.18, .a = 9.62e+03},
     {.serial_preparing = 1, .serial_search = 0.198, .start = 0}},
    {Technique::bvh,
     {.w = 3.57, .b = 322, .h = 168, .i = 73.4, .e = 57.7, .a = 8.23e+04},
     {.serial_preparing = 0.00424, .serial_search = 0.177, .start = 2.14e-05}},
    {Technique::ray_map, {.w = 3.89, .n = 29.7, .c = 41.2, .r = 1.54, .h = 301, .i = 37.3, .e = 0.546}}};

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
