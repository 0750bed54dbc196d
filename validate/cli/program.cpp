#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <new>
#include <stdexcept>
#include <system_error>

#include "command_line.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/validate/cli/options/outputs.hpp"
#include "detp/validate/cli/text/messages.hpp"
#include "envelope.hpp"
#include "interruption.hpp"
#include "program.hpp"
#include "stop_report.hpp"

namespace detp::cli {
namespace {

/// Throws std::logic_error if a number is NaN or infinite, which JSON cannot represent. Such a number is a bug.
void require_finite_numbers(const Json& json) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    throw std::logic_error("a result is not a finite number");
  if (json.is_structured())
    for (const Json& part : json) require_finite_numbers(part);
}

/// Writes to the file `output`, or to stdout without one.
void print(const std::string& text, const std::optional<std::string>& output) {
  if (output) {
    sim::OutputFile file(*output);
    file.write(text);
    file.commit();
  } else {
    write_result(text);
  }
}

void set_memory_limit(const std::string& size) {
  try {
    sim::set_memory_limit(sim::parse_bytes(size));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("--memory-limit {}", error.what()));
  }
}

/// Runs the command. If it is stopped before it has a result, says so on stderr and returns stopped_result().
Result result_of(const Command& command, const CommonOptions& common, const std::stop_token& stop) {
  try {
    return command.run(common, stop);
  } catch (const sim::Stopped& stopped) {
    static_cast<void>(fail(ExitCode::stopped, stopped.what()));
    return stopped_result(*command.app, stopped);
  }
}

int run(const Command& command, const CommonOptions& common, Interruption& interruption) {
  if (common.memory_limit) set_memory_limit(*common.memory_limit);
  const int wanted = sim::thread_count(common.threads);
  const int threads = sim::startable_threads(wanted);
  if (threads < wanted) note(common, fmt::format("the system starts {} threads only, not {}", threads, wanted));
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
  require_non_negative("--time-limit", common.time_limit);
  check_outputs({{"--output", common.output}});
  interruption.limit(common.time_limit);
  Result result = sim::in_memory(fmt::format("detp {} was at work", command.app->get_name()),
                                 [&] { return result_of(command, common, interruption.token()); });
  if (result.code == ExitCode::stopped && !result.stopped) result.stopped.emplace();
  if (result.answers_at_limit && interruption.by_limit()) result.stopped.reset();
  result.json["stopped"] = result.stopped.has_value();
  if (result.stopped) mark_stopped(result, interruption.seconds_since_request(), common.screen());
  const auto output = result.output_is_written ? std::optional<std::string>() : common.output;
  if (common.format == "json") {
    const Json json = envelope(command.app->get_name(), common, threads, result);
    require_finite_numbers(json);
    // Invalid UTF-8, for instance in a file's name, is replaced, because JSON must be valid.
    print(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", output);
  } else {
    print(common.format == "csv" ? result.csv : safe_text(result.text, common.screen().colour), output);
  }
  return static_cast<int>(result.not_reached ? ExitCode::stopped : result.code);
}

int guarded_main(int argc, char** argv) {
  Interruption interruption;
  CommandLine line;
  if (argc <= 1) {
    write_result(line.overview());
    return 0;
  }
  try {
    return run(line.parse(argc, argv), line.common(), interruption);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      line.exit(error);
      check_written();
      return 0;
    }
    return fail(ExitCode::bad_input,
                with_short_arguments(line.message(error), {argv, argv + argc}) + " (detp --help tells more)");
  }
}

}  // namespace

int run_program(int argc, char** argv) {
  prepare_streams();
  try {
    return guarded_main(argc, argv);
  } catch (const sim::FileError& error) {
    return fail(ExitCode::bad_input, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(ExitCode::bad_input, with_short_arguments(error.what(), {argv, argv + argc}));
  } catch (const std::length_error& error) {
    return fail(ExitCode::bad_input, error.what());
  } catch (const std::overflow_error& error) {
    return fail(ExitCode::bad_input, error.what());
  } catch (const sim::OutOfMemory& error) {
    return fail(ExitCode::bad_input, std::string(error.what()) + "; fewer rays, samples or cells would fit");
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::bad_input, "out of memory; fewer rays, samples or cells would fit");
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again)
      return fail(ExitCode::bad_input, "the system starts no thread; allow more processes (ulimit -u) or memory");
    return fail(ExitCode::internal, std::string("internal error: ") + error.what());
  } catch (const std::exception& error) {
    return fail(ExitCode::internal, std::string("internal error: ") + error.what());
  }
}

}  // namespace detp::cli
