#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <new>
#include <stdexcept>

#include "command.hpp"
#include "detp/model/vocabulary.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/scene/file_error.hpp"
#include "detp/sim/scene/output_file.hpp"
#include "detp/sim/stopped.hpp"
#include "detp/sim/threads.hpp"
#include "interruption.hpp"
#include "messages.hpp"
#include "number_option.hpp"
#include "outputs.hpp"

namespace detp::cli {
namespace {

std::string cpu_name() {
  std::ifstream cpus("/proc/cpuinfo");
  for (std::string line; std::getline(cpus, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

Json envelope(const std::string& command, const CommonOptions& common, int threads, Result& result) {
  Json json{{"schema", {{"name", "detp." + command}, {"version", 1}}}, {"inputs", std::move(result.inputs)}};
  json.update(result.json);
  json["provenance"] = {
      {"program", "detp"}, {"version", DETP_VERSION}, {"seed", common.seed}, {"threads", threads}, {"cpu", cpu_name()}};
  return json;
}

/// Throws where a number is NaN or infinite, which JSON cannot hold: a defect of ours, not of the input.
void require_finite_numbers(const Json& json) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    throw std::logic_error("a result is not a finite number");
  if (json.is_structured())
    for (const Json& part : json) require_finite_numbers(part);
}

void print(const std::string& text, const CommonOptions& common) {
  if (common.output) {
    sim::OutputFile file(*common.output);
    file.write(text);
    file.commit();
  } else {
    write_result(text);
  }
}

/// Up to 2⁶⁴ - 1, which no double holds.
std::uint64_t parse_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size())
    throw std::invalid_argument(fmt::format("--seed must be a whole number from 0 to {} (got {})",
                                            std::numeric_limits<std::uint64_t>::max(), detp::quoted(text)));
  return seed;
}

void add_common_options(CLI::App& command, CommonOptions& common) {
  command.add_option("--format", common.format, "text, json or csv")->check(CLI::IsMember({"text", "json", "csv"}));
  command.add_option("-o,--output", common.output, "write the result to a file instead of stdout");
  command.add_flag("--quiet", common.quiet, "no notices, no progress");
  command
      .add_option_function<std::string>(
          "--seed", [&common](const std::string& text) { common.seed = parse_seed(text); }, "of everything random")
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--threads",
          [&common](const std::string& text) {
            common.threads = static_cast<int>(parse_whole("--threads", text, 0, 4096));
          },
          "default: all cores")
      ->type_name("N");
  add_number(command, "--time-limit", common.time_limit, "stop after that many seconds and show what there is");
}

int run(const Command& command, const CommonOptions& common, Interruption& interruption) {
  const int threads = sim::thread_count(common.threads);
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
  require_non_negative("--time-limit", common.time_limit);
  check_outputs({{"--output", common.output}});
  interruption.limit(common.time_limit);
  Result result = command.run(common, interruption.token());
  if (common.format == "json") {
    const Json json = envelope(command.app->get_name(), common, threads, result);
    require_finite_numbers(json);
    // A file's name may be no UTF-8, which JSON must be.
    print(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", common);
  } else {
    print(common.format == "csv" ? result.csv : safe_text(result.text), common);
  }
  return static_cast<int>(result.code);
}

int guarded_main(int argc, char** argv) {
  Interruption interruption;
  CLI::App program("Predicts, runs and checks techniques that find which rays cross which discs.", "detp");
  program.set_version_flag("--version", "detp " DETP_VERSION);
  program.require_subcommand(0, 1);  // with 1 needed, an unknown command would be reported as a missing one
  CommonOptions common;
  const std::array commands{model_command(program),    choose_command(program), run_command(program),
                            validate_command(program), scene_command(program),  bench_command(program)};
  for (const Command& command : commands) add_common_options(*command.app, common);
  for (int i = 1; i < argc; ++i)
    if (*argv[i] == '\0')  // the parser would take an empty value for none, as of --rays "$n" where n is not set
      throw std::invalid_argument(fmt::format("argument {} is empty, after {}; give it a value", i, argv[i - 1]));
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      program.exit(error);
      check_written();
      return 0;
    }
    return fail(ExitCode::bad_input,
                with_short_arguments(error.what(), {argv, argv + argc}) + " (detp --help tells more)");
  }
  for (const Command& command : commands)
    if (command.app->parsed()) return run(command, common, interruption);
  throw std::invalid_argument(
      "a command is needed: model, choose, run, validate, scene or bench (detp --help tells more)");
}

}  // namespace
}  // namespace detp::cli

int main(int argc, char** argv) {
  using namespace detp::cli;
  prepare_streams();
  try {
    return guarded_main(argc, argv);
  } catch (const detp::sim::Stopped& stopped) {
    return fail(ExitCode::stopped, stopped.what());
  } catch (const detp::sim::FileError& error) {
    return fail(ExitCode::bad_input, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(ExitCode::bad_input, with_short_arguments(error.what(), {argv, argv + argc}));
  } catch (const std::length_error& error) {
    return fail(ExitCode::bad_input, error.what());
  } catch (const std::overflow_error& error) {
    return fail(ExitCode::bad_input, error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::bad_input, "out of memory: fewer rays, samples or cells would fit");
  } catch (const std::exception& error) {
    return fail(ExitCode::internal, std::string("internal error: ") + error.what());
  }
}
