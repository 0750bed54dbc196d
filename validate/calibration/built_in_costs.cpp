#include "built_in_costs.hpp"

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

}  // namespace

CostTable built_in_unit_costs() {
  CostTable costs;
  const auto set = [&](Technique technique, const Nanoseconds& of_one) { costs[technique] = of_one.seconds(); };
  set(Technique::brute_force, {.u = 0.438, .l = 21.8, .i = 5.87, .m = 0.715, .a = 3.69e+03});
  set(Technique::sphere_cache, {.t = 0.487, .u = 0.401, .c = 0.916, .r = 111, .l = 184, .i = 5.23, .m = 87.8});
  set(Technique::sphere_cache_published,
      {.t = 0.487, .u = 0.401, .c = 0.916, .r = 111, .l = 184, .i = 5.23, .m = 87.8});
  set(Technique::cell_spheres, {.t = 0.62, .u = 0.494, .s = 68.1, .r = 133, .l = 233, .i = 10.2, .m = 205});
  set(Technique::sphere_tree, {.t = 7.32, .u = 3.86, .c = 4.57, .g = 163, .s = 118, .h = 73.7, .m = 22.5});
  set(Technique::box_tree, {.t = 0.554,
                            .u = 0.449,
                            .c = 1.33,
                            .p = 44.3,
                            .g = 57.6,
                            .r = 37.4,
                            .l = 15.3,
                            .i = 4.48,
                            .m = 7.5,
                            .a = 3.62e+03});
  set(Technique::octree, {.w = 3.07, .n = 74.6, .b = 98.1, .h = 97, .m = 49.9});
  set(Technique::grid, {.w = 3.77, .v = 34.8, .b = 92.3, .h = 148, .i = 4.54, .m = 115});
  set(Technique::bsp, {.w = 2.78, .n = 42.3, .b = 46.7, .h = 110, .m = 7.67});
  set(Technique::bvh, {.b = 292, .h = 155, .i = 101, .m = 1.77, .a = 3.18e+04});
  set(Technique::ray_map, {.w = 0.564, .n = 43.6, .c = 36.3, .h = 51, .m = 14.5});
  return costs;
}

}  // namespace detp::validate
