#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "support/pages.hpp"

namespace detp::support {
namespace {

/// Seconds of one workload with one instruction set.
struct Sides {
  double embree = HUGE_VAL;
  double ours = HUGE_VAL;
  double choice = HUGE_VAL;
};

std::vector<Sides> races_with(const std::string& set) {
  std::map<std::string, Sides> races;
  for (const CsvRow& row : published("bench_sets.csv")) {
    if (row.at("instruction_set") != set) continue;
    Sides& race = races[row.at("scene") + row.at("field") + row.at("rays") + "," + row.at("disc_radius")];
    const std::string& who = row.at("technique");
    double& best = who == "embree" ? race.embree : who == "choice" ? race.choice : race.ours;
    best = std::min(best, number(row, "seconds"));
  }
  std::vector<Sides> all;
  for (const auto& [workload, race] : races) all.push_back(race);
  return all;
}

/// "5.37, 1.90": geometric mean and least of Embree's seconds over those of a side.
std::string times(const std::vector<Sides>& races, double Sides::*side) {
  double sum = 0;
  double least = HUGE_VAL;
  for (const Sides& race : races) {
    const double ratio = race.embree / race.*side;
    sum += std::log(ratio);
    least = std::min(least, ratio);
  }
  return fmt::format("{:.2f}, {:.2f}", std::exp(sum / static_cast<double>(races.size())), least);
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("the page of the benchmark has the figures of bench_sets.csv") {
    const std::string page = source_text("validate/bench/README.md");
    for (const std::string set : {"AVX2", "SSE4"}) {
      const std::vector<Sides> races = races_with(set);
      CHECK(races.size() >= 50);
      check_says(page, fmt::format("| {} | {} | {} | {} |", set, races.size(), times(races, &Sides::choice),
                                   times(races, &Sides::ours)));
    }
    const std::vector<Sides> races = races_with("AVX2");
    const std::string choice = times(races, &Sides::choice);
    const std::size_t comma = choice.find(',');
    check_says(source_text("validate/trust.md"),
               fmt::format("its price inside: {} on {} workloads, least{}", choice.substr(0, comma), races.size(),
                           choice.substr(comma + 1)));
  }
}

}  // namespace detp::support
