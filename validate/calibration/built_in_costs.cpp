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
  set(Technique::brute_force, {.u = 0.611, .l = 42.5, .h = 1.02, .i = 6.67, .a = 5.5e+03});
  set(Technique::sphere_cache,
      {.t = 0.489, .u = 0.432, .c = 1.32, .r = 169, .l = 321, .h = 2.9, .i = 12.3, .m = 267, .a = 4e+03});
  set(Technique::sphere_cache_published,
      {.t = 0.489, .u = 0.432, .c = 1.32, .r = 169, .l = 321, .h = 2.9, .i = 12.3, .m = 267, .a = 4e+03});
  set(Technique::cell_spheres,
      {.t = 0.694, .u = 0.806, .s = 96.4, .r = 249, .l = 326, .i = 13.1, .m = 167, .a = 6.17e+03});
  set(Technique::sphere_tree, {.t = 8.66, .u = 6.16, .c = 15.9, .s = 203, .r = 100, .h = 121, .m = 31.5});
  set(Technique::box_tree, {.t = 0.702,
                            .u = 0.545,
                            .c = 1.51,
                            .p = 69.3,
                            .r = 168,
                            .l = 6.83,
                            .h = 0.316,
                            .i = 5.12,
                            .m = 13.3,
                            .a = 1.08e+04});
  set(Technique::octree, {.w = 5.55, .n = 105, .b = 168, .h = 146, .m = 221});
  set(Technique::grid, {.w = 6.43, .v = 45.3, .b = 136, .h = 206, .m = 127});
  set(Technique::bsp, {.w = 3.59, .n = 78.4, .b = 75.5, .h = 191, .a = 1.62e+03});
  set(Technique::bvh, {.w = 91.6, .b = 384, .i = 108, .m = 14.3, .a = 7.69e+04});
  set(Technique::ray_map, {.w = 2.85, .n = 48.3, .c = 53.7, .h = 113, .m = 20.9});
  return costs;
}

}  // namespace detp::validate
