#pragma once

#include "detp/validate/regret/regret.hpp"

/// Rows of `bench --regret` with times made up by hand.
namespace detp::support {

/// A row of one tier, "estimate". Its choice, a box tree, takes `regret` times as long as the best, a grid, which takes
/// 10 ms. The choice takes 5 ms, and is predicted to take as long as the best. All options of all baselines take
/// `of_baselines` times as long as the best.
inline validate::RegretRow regret_row(double regret, bool held_out, double of_baselines = 2, int threads = 1) {
  validate::RegretRow row{.workload = {.scene = held_out ? "sponza" : "@tree",
                                       .discs = "@tree",
                                       .disc_radius = {0.01, true},
                                       .rays = 1000,
                                       .held_out = held_out},
                          .rays = 1200,
                          .samples = 500,
                          .disc_radius = 0.25,
                          .threads = threads,
                          .best = {Technique::grid, GridParameters{}},
                          .best_threads = 1,
                          .best_seconds = 0.01,
                          .noise = 1,
                          .tried = 30,
                          .choices = {},
                          .baselines = {}};
  row.choices.push_back(
      {.tier = "estimate",
       .choice = {{.candidate = {Technique::box_tree, BoxTreeParameters{}}, .time = {.intersect = 0.01}}, 0.005},
       .seconds = 0.01 * regret,
       .regret = {regret},
       .reason = "unit costs"});
  for (const validate::Baseline& baseline : validate::baselines())
    row.baselines.emplace_back(baseline.candidates(cube_workload(1200, 500, 0.25, 25)).size(),
                               validate::Regret{of_baselines});
  return row;
}

}  // namespace detp::support
