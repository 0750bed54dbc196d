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

// All from one run of detp calibrate on a machine with two cores; left-out workloads were 10 % off in the median. So the costs
// of more than two threads are extrapolated. Too few runs of brute force and, by the plain engine, of box trees were divided
// among threads in that run: these costs of threads are from an earlier run.
constexpr BuiltIn of_simd[] = {
    {Technique::brute_force,
     {.u = 0.52, .l = 41.3, .h = 1.18, .i = 17.6, .e = 0.181, .m = 1.89, .a = 1.7e+04},
     {.serial_preparing = 1, .serial_search = 0.0519, .start = 1.09e-05}},
    {Technique::sphere_cache,
     {.t = 0.342, .u = 0.874, .c = 1.88, .r = 163, .l = 280, .h = 1.32, .i = 15, .e = 0.283, .m = 290, .a = 1.74e+04},
     {.serial_preparing = 1, .serial_search = 0, .start = 1.04e-05}},
    {Technique::cell_spheres,
     {.t = 1.02, .u = 0.987, .c = 0.314, .r = 290, .l = 366, .i = 4.2, .e = 0.214, .a = 1.73e+04},
     {.serial_preparing = 1, .serial_search = 0, .start = 6.75e-06}},
    {Technique::box_tree,
     {.t = 0.703,
      .u = 0.454,
      .c = 1.14,
      .p = 66.3,
      .g = 126,
      .r = 113,
      .l = 18.1,
      .i = 13.6,
      .e = 0.17,
      .m = 2.9,
      .a = 1.29e+04},
     {.serial_preparing = 0.244, .serial_search = 0.116, .start = 0.000145}}};

constexpr BuiltIn of_plain[] = {
    {Technique::brute_force,
     {.u = 4.8, .l = 35.7, .h = 124, .i = 56.4, .e = 0.684},
     {.serial_preparing = 1, .serial_search = 0.0828, .start = 3.8e-05}},
    {Technique::sphere_cache,
     {.t = 7.49, .u = 6.59, .c = 28, .s = 80.3, .r = 30.5, .h = 105, .e = 8.07, .m = 22.3, .a = 344}},
    {Technique::cell_spheres,
     {.t = 10.7, .u = 5.94, .c = 16.4, .s = 76.7, .r = 235, .h = 127, .e = 4.62, .m = 18.2, .a = 3.37e+03}},
    {Technique::box_tree,
     {.t = 11.2,
      .u = 4.64,
      .c = 26.4,
      .p = 63.4,
      .g = 92.5,
      .r = 17.5,
      .l = 1.54,
      .h = 117,
      .i = 2.4,
      .e = 0.907,
      .m = 6.16,
      .a = 9.72e+03},
     {.serial_preparing = 0.236, .serial_search = 1, .start = 5.31e-05}}};

/// Of techniques without a simd engine.
constexpr BuiltIn of_both[] = {
    {Technique::sphere_tree,
     {.t = 7.56,
      .u = 3.27,
      .c = 16.9,
      .g = 249,
      .s = 156,
      .r = 59,
      .l = 31.7,
      .h = 118,
      .i = 85.9,
      .e = 2.08,
      .m = 7.5}},
    {Technique::octree,
     {.w = 4.8, .n = 138, .b = 133, .h = 201, .e = 0.984, .m = 49.4, .a = 5.67e+03},
     {.serial_preparing = 1, .serial_search = 0, .start = 2.45e-05}},
    {Technique::grid,
     {.w = 4.95, .v = 41.8, .b = 134, .h = 350, .i = 47.5, .e = 0.995, .m = 96.9, .a = 4.49e+03},
     {.serial_preparing = 1, .serial_search = 0.157, .start = 6.7e-06}},
    {Technique::bsp,
     {.w = 7.12, .n = 19.3, .b = 58, .h = 151, .e = 0.996, .a = 6.59e+03},
     {.serial_preparing = 1, .serial_search = 0.103, .start = 5.72e-06}},
    {Technique::bvh,
     {.w = 19.2, .b = 387, .h = 145, .i = 124, .e = 12.2, .a = 1.86e+05},
     {.serial_preparing = 0, .serial_search = 0.0411, .start = 0}},
    {Technique::ray_map, {.w = 6.32, .n = 18.9, .c = 52, .h = 215, .i = 29.5, .e = 1.28, .m = 0.342, .a = 7.54e+03}}};

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
