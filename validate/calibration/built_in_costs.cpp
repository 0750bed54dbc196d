#include "built_in_costs.hpp"

namespace detp::validate {
namespace {

/// Costs in nanoseconds by symbol, as `detp calibrate` prints them. Costs that are not named are 0.
struct Nanoseconds {
  double t = 0, u = 0, w = 0, v = 0, n = 0, c = 0, b = 0, p = 0, s = 0, r = 0, l = 0, h = 0, i = 0, m = 0, a = 0;

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
            .sort = nano * s,
            .cull = nano * r,
            .visit = nano * l,
            .hit = nano * h,
            .ray = nano * i,
            .far = nano * m,
            .start = nano * a};
  }
};

}  // namespace

CostTable built_in_unit_costs() {
  CostTable costs;
  const auto set = [&](Technique technique, const Nanoseconds& of_one) { costs[technique] = of_one.seconds(); };
  set(Technique::brute_force, {.u = 0.685, .l = 28, .i = 2.09, .a = 1.04e+04});
  set(Technique::sphere_cache, {.t = 0.791, .u = 0.73, .c = 0.868, .s = 365, .r = 163, .i = 6.98});
  set(Technique::sphere_cache_published, {.t = 0.791, .u = 0.73, .c = 0.868, .s = 365, .r = 163, .i = 6.98});
  set(Technique::cell_spheres, {.t = 0.964, .u = 0.989, .r = 206, .l = 476, .i = 6.35});
  set(Technique::sphere_tree, {.t = 13, .u = 6.48, .s = 158, .r = 19.1, .h = 107});
  set(Technique::box_tree,
      {.t = 0.826, .u = 0.546, .c = 1.36, .p = 90.4, .r = 143, .h = 0.676, .i = 8.22, .m = 24.3, .a = 7e+03});
  set(Technique::octree, {.w = 5.43, .n = 72.8, .b = 218, .h = 88.9, .m = 417});
  set(Technique::grid, {.w = 5.88, .v = 49.7, .b = 166, .h = 206, .m = 176});
  set(Technique::bsp, {.w = 4.12, .n = 74.9, .b = 74.1, .h = 174});
  set(Technique::bvh, {.w = 70.4, .b = 414, .h = 36.6, .i = 157, .a = 8.5e+04});
  set(Technique::ray_map, {.w = 5.59, .n = 39.1, .c = 57.1, .h = 53.3});
  return costs;
}

}  // namespace detp::validate
