#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/validate/choice/analysis.hpp"

namespace detp::cli {

/// Everything that the answer shows.
struct ChooseAnswer {
  std::string title;  ///< first lines of the text: scene and rays
  Workload workload;
  std::vector<model::Ranked> ranking;
  model::Ranked paper;  ///< the paper's rule of thumb
  std::optional<validate::Analysis> analysis;
  std::string rigor = "estimate";
  UnitCosts costs;
  bool costs_given = false;  ///< by the user; else the built-in unit costs
  double choosing_seconds = 0;
  std::vector<std::string> warnings;
};

[[nodiscard]] Json to_json(const ChooseAnswer& answer);
[[nodiscard]] std::string to_text(const ChooseAnswer& answer);

/// A row for each candidate, as ranked, those tried beside, and one for the paper's rule. The workload is taken from
/// the resolved inputs.
[[nodiscard]] std::string to_csv(const ChooseAnswer& answer, const Json& inputs);

}  // namespace detp::cli
