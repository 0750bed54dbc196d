#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stop_token>

#include "detp/validate/base/fields.hpp"
#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/text/result.hpp"

namespace detp::cli {

/// One command: its parser, and the function that runs it after the options have been parsed.
struct Command {
  CLI::App* app;
  std::function<Result(const CommonOptions&, std::stop_token)> run;
  bool on_ranks = false;                         ///< several processes may run it together: CommonOptions::ranks
  std::vector<validate::FieldText> fields = {};  ///< of its answer
};

[[nodiscard]] Command model_command(CLI::App& program);
[[nodiscard]] Command choose_command(CLI::App& program);
[[nodiscard]] Command run_command(CLI::App& program);
[[nodiscard]] Command validate_command(CLI::App& program);
[[nodiscard]] Command scene_command(CLI::App& program);
[[nodiscard]] Command bench_command(CLI::App& program);
[[nodiscard]] Command calibrate_command(CLI::App& program);
[[nodiscard]] Command accuracy_command(CLI::App& program);
[[nodiscard]] Command report_command(CLI::App& program);

}  // namespace detp::cli
