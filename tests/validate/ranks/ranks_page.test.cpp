#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "detp/model/rank/predict.hpp"
#include "detp/model/ranks/ranks.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "support/pages.hpp"

namespace detp::support {
namespace {

Prediction predicted(double rays, double samples) {
  const double half_distance = std::sqrt(6 / samples) / 2;
  const Candidate tree{Technique::box_tree, BoxTreeParameters{8, 8}};
  const Counts<double> counts = model::predict(cube_workload(rays, samples, half_distance, 1, 2), tree);
  return {
      .candidate = tree, .counts = counts, .time = price(counts, validate::built_in_unit_costs()[Technique::box_tree])};
}

/// 10¹⁰ lines and 10⁸ discs: the largest measured run, times what the closed forms say is more.
model::SharedSearch on_paper(const CsvRow& largest) {
  const double rays = 1e10;
  const double discs = 1e8;
  const double more =
      predicted(rays, discs).time.total() / predicted(number(largest, "rays"), number(largest, "samples")).time.total();
  const double search_seconds = number(largest, "search_seconds") * more;
  const UnitCosts costs = validate::built_in_unit_costs()[Technique::box_tree];
  return {.rays = rays,
          .photons = rays,
          .discs = discs,
          .photons_in_block = 0x1p24,
          .make_seconds = number(largest, "make_seconds") * rays / number(largest, "rays"),
          .build_seconds = number(largest, "build_seconds") * discs / number(largest, "samples"),
          .search_seconds = search_seconds,
          .each_ray_seconds = search_seconds * model::share_of_each_ray(predicted(rays, discs), costs, discs)};
}

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = 0;

  void include(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  [[nodiscard]] std::string text() const { return fmt::format("{:.2g} to {:.2g}", least, most); }
};

std::string time_text(const model::SharedTime& time) {
  return fmt::format("{:.3g} s, {:.3g} GB, {:.2g} GB", time.total(), time.memory / 1e9, time.traffic / 1e9);
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("what the page says of predictions follows from ranks.csv") {
    const std::string page = source_text("model/ranks/README.md");
    Range search;
    Range parts;  // of discs
    Range make;
    Range memory;
    Range two;
    double alone = 0;
    for (const CsvRow& row : published("ranks.csv")) {
      search.include(number(row, "search_seconds") / number(row, "predicted_search"));
      if (row.at("share") == "discs") parts.include(number(row, "search_seconds") / number(row, "predicted_search"));
      make.include(number(row, "make_seconds") / number(row, "predicted_make"));
      memory.include(number(row, "memory") / number(row, "predicted_memory"));
      if (row.at("processes") == "1") alone = number(row, "seconds");
      if (row.at("processes") == "2" && row.at("share") == "rays") two.include(number(row, "seconds") / alone);
    }
    check_says(page, fmt::format("Searches take {} times as long as predicted", search.text()));
    check_says(page, fmt::format("that share discs searched {} times as long", parts.text()));
    check_says(page, fmt::format("Making and counting rays takes {} times as long", make.text()));
    check_says(page, fmt::format("memory is {} times what was predicted", memory.text()));
    check_says(page, fmt::format("Two processes that share rays take {} of the time of one", two.text()));
  }

  TEST_CASE("the page's runs on processes are those of ranks.csv") {
    const std::string page = source_text("model/ranks/README.md");
    for (const CsvRow& row : published("ranks.csv"))
      check_says(page, fmt::format("| {} | {:.2g} | {:.2g} | {} | {} | {:.3g} s | {:.3g} s | {:.2g} GB | {:.2g} GB |",
                                   row.at("rays_of"), number(row, "rays"), number(row, "samples"), row.at("processes"),
                                   row.at("share"), number(row, "predicted_seconds"), number(row, "seconds"),
                                   number(row, "predicted_memory") / 1e9, number(row, "memory") / 1e9));
  }

  TEST_CASE("the page's estimate of 10¹⁰ rays and 10⁸ discs follows from the largest run") {
    const std::string page = source_text("model/ranks/README.md");
    const model::SharedSearch search = on_paper(published("ranks.csv").back());
    check_says(page, fmt::format("{:.3g} s for making the lines, {:.3g} s for the index, {:.3g} s for the search",
                                 search.make_seconds, search.build_seconds, search.search_seconds));
    for (const double ranks : {1.0, 8.0, 64.0, 512.0, 4096.0})
      check_says(page, fmt::format("| {} | {} | {} |", ranks, time_text(share_rays(search, ranks)),
                                   time_text(share_discs(search, ranks))));
  }
}

}  // namespace detp::support
