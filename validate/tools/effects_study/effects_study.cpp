// What does each effect change, and does `auto` choose as well as `all`? On many scenes.
//
//   cmake --build build --target effects_study && build/effects_study FOLDER [FOLDER OF MESHES] > summary.md
//   build/effects_study FOLDER --families SEED
//
// The second form takes the scenes that the seed makes, and writes FOLDER/effects_families.csv, as effects_choice.csv.
// Writes FOLDER/effects.csv, a row for each effect of each scene, field and radius: evidence, whether the effect is on,
// and what switching it by hand changes; and FOLDER/effects_choice.csv, a row for each workload: predicted tests and the
// choice by closed forms with the effects that evidence calls for, with all and with none. Prints summaries of both.
// Scenes on which thresholds were selected stand apart. One thread; some ten minutes with the meshes.

#include <fmt/format.h>

#include <exception>
#include <fstream>
#include <string>
#include <string_view>

#include "choice_table.hpp"
#include "effects_table.hpp"
#include "study_scenes.hpp"

namespace {

using namespace detp;

constexpr double rays_of_effects = 20'000;

/// Adds the workload to the table. Says on stderr why it was left out, if it was.
template <class Table>
void add(Table& table, const validate::RegretWorkload& workload, study::StudyWorkload::Effort effort) {
  try {
    table.add(study::StudyWorkload(workload, effort));
  } catch (const std::exception& error) {
    fmt::print(stderr, "left out: {}, radius {}, {} rays: {}\n", workload.scene, workload.radius, workload.rays,
               error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  using enum study::StudyWorkload::Effort;
  if (argc < 2) {
    fmt::print(stderr, "usage: effects_study FOLDER [FOLDER OF MESHES | --families SEED]\n");
    return 2;
  }
  const std::string folder = argv[1];
  if (argc == 4 && std::string_view(argv[2]) == "--families") {
    study::ChoiceTable choices;
    for (const auto& workload : validate::family_workloads(std::stoull(argv[3]))) add(choices, workload, priced);
    std::ofstream(folder + "/effects_families.csv") << choices.csv();
    fmt::print("{}", choices.summary());
    return 0;
  }
  study::EffectsTable effects;
  study::ChoiceTable choices;
  for (const study::StudyScene& scene : study::study_scenes(argc > 2 ? argv[2] : "")) {
    for (const double radius : {0.0025, 0.02})
      for (const auto& workload : study::with_fields(scene, radius, rays_of_effects)) add(effects, workload, all);
    for (const double radius : {0.0025, 0.01, 0.04})
      for (const double rays : {1e3, 3e4})
        for (const auto& workload : study::with_fields(scene, radius, rays)) add(choices, workload, priced);
    fmt::print(stderr, "{}\n", scene.name);
  }
  std::ofstream(folder + "/effects.csv") << effects.csv();
  std::ofstream(folder + "/effects_choice.csv") << choices.csv();
  fmt::print("Effects\n\n{}\nChoices\n\n{}", effects.summary(), choices.summary());
}
