#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/types.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <system_error>

#include "command_line.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/text/messages.hpp"
#include "envelope.hpp"
#include "interruption.hpp"
#include "program.hpp"

/// Of jemalloc, with which the command is linked, but not all that link this library.
extern "C" [[gnu::weak]] int mallctl(const char* name, void* old, std::size_t* old_size, void* value, std::size_t size);

namespace detp::cli {
namespace {

/// Throws std::logic_error if a number is NaN or infinite, which JSON cannot represent. Such a number is a bug.
void require_finite_numbers(const Json& json) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    throw std::logic_error("a result is not a finite number");
  if (json.is_structured())
    for (const Json& part : json) require_finite_numbers(part);
}

/// Writes to the file `output`, or to stdout without one. A time limit does not end the wait for a reader of stdout.
void print(const std::string& text, const std::optional<std::string>& output, const Interruption& interruption) {
  if (!output) return write_result(text, interruption.signal_token());
  sim::OutputFile file(*output, interruption.token());
  file.write(text);
  file.commit();
}

/// Freed memory goes back to the system, in small pages: slower, but the peak is what the work needs. (Main's allocator keeps it.)
void return_memory_at_once() {
#ifdef PR_SET_THP_DISABLE
  prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
#endif
  ssize_t none = 0;
  if (mallctl != nullptr) static_cast<void>(mallctl("arena.0.dirty_decay_ms", nullptr, nullptr, &none, sizeof none));
}

void set_memory_limit(const std::string& size) {
  try {
    sim::set_memory_limit(sim::parse_bytes(size));
    return_memory_at_once();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("--memory-limit {}", error.what()));
  }
}

/// Runs the command. If it is stopped before it has a result, says so on stderr and returns stopped_result().
Result result_of(const Command& command, const CommonOptions& common, const std::stop_token& stop) {
  try {
    if (common.answers()) check_files(*command.app, common, stop);
    return command.run(common, stop);
  } catch (const sim::Stopped& stopped) {
    static_cast<void>(fail(ExitCode::stopped, stopped.what()));
    return stopped_result(*command.app, stopped);
  }
}

/// The options of this process. Throws std::invalid_argument if the command works on one process only.
CommonOptions options_on(World* world, const Command& command, CommonOptions common) {
  settle_format(*command.app, common);
  if (world == nullptr) return common;
  if (!command.on_ranks)
    throw std::invalid_argument(
        fmt::format("detp {} works on one process; detp run, accuracy and validate work on several, as mpirun -n {}",
                    command.app->get_name(), world->ranks().count()));
  common.ranks = &world->ranks();
  if (common.threads == 0) common.threads = world->cores();
  if (common.colour == Colour::automatic)
    common.colour = Colour::never;  // mpirun's output is a terminal, wherever it goes
  if (common.answers()) return common;
  common.output.reset();
  common.quiet = true;
  return common;
}

int run(const Command& command, const CommonOptions& common, Interruption& interruption) {
  if (common.memory_limit) set_memory_limit(*common.memory_limit);
  const int wanted = sim::thread_count(common.threads);
  const int threads = sim::startable_threads(wanted);
  if (threads < wanted) note(common, fmt::format("the system starts {} of {} threads only", threads, wanted));
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
  require_non_negative("--time-limit", common.time_limit);
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
    print(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", output, interruption);
  } else {
    print(common.format == "csv" ? result.csv : safe_text(result.text, common.screen().colour), output, interruption);
  }
  return static_cast<int>(result.not_reached ? ExitCode::stopped : result.code);
}

int guarded_main(int argc, char** argv, Interruption& interruption, World* world) {
  CommandLine line;
  if (argc <= 1) {
    write_result(line.overview());
    return 0;
  }
  try {
    const Command& command = line.parse(argc, argv);
    return run(command, options_on(world, command, line.common()), interruption);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      line.exit(error);
      check_written();
      return 0;
    }
    throw std::invalid_argument(line.message(error) + " (detp --help tells more)");
  }
}

struct Failure {
  ExitCode code;
  std::string message;
  bool all_tell = false;  ///< not rank 0 alone
};

/// What is being thrown.
Failure current_failure(std::span<char* const> arguments) {
  try {
    throw;
  } catch (const sim::FileError& error) {
    return {ExitCode::bad_input, error.what()};
  } catch (const sim::Stopped& stopped) {
    return {ExitCode::stopped, stopped.what()};
  } catch (const std::invalid_argument& error) {
    return {ExitCode::bad_input, with_short_arguments(error.what(), arguments)};
  } catch (const std::length_error& error) {
    return {ExitCode::bad_input, error.what()};
  } catch (const std::overflow_error& error) {
    return {ExitCode::bad_input, error.what()};
  } catch (const sim::OutOfMemory& error) {
    return {ExitCode::bad_input, std::string(error.what()) + "; fewer rays, samples or cells would fit"};
  } catch (const std::bad_alloc&) {
    return {ExitCode::bad_input, "out of memory; fewer rays, samples or cells would fit"};
  } catch (const sim::RankSilent& error) {
    return {ExitCode::internal, error.what(), true};
  } catch (const sim::RankFailed& error) {
    return {ExitCode::internal, error.what()};
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again)
      return {ExitCode::internal,
              "the system starts no thread; allow more processes (ulimit -u) or memory (ulimit -v)"};
    return {ExitCode::internal, std::string("internal error: ") + error.what()};
  } catch (const std::exception& error) {
    return {ExitCode::internal, std::string("internal error: ") + error.what()};
  }
}

int run_on(World& world, int argc, char** argv, Interruption& interruption) {
  std::optional<Muted> muted;
  if (world.ranks().rank() != 0) muted.emplace();
  int code = 0;
  std::string message;
  try {
    code = guarded_main(argc, argv, interruption, &world);
  } catch (...) {
    Failure failure = current_failure({argv, argv + argc});
    code = static_cast<int>(failure.code);
    if (failure.all_tell) muted.reset();
    if (!muted) fail(failure.code, failure.message);
    if (!failure.all_tell) message = std::move(failure.message);
  }
  world.end(message, code);
  return code;
}

int run_alone(int argc, char** argv, Interruption& interruption) {
  try {
    return guarded_main(argc, argv, interruption, nullptr);
  } catch (...) {
    const Failure failure = current_failure({argv, argv + argc});
    return fail(failure.code, failure.message);
  }
}

}  // namespace

int launched_processes() {
  int most = 1;
  for (const char* const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})  // Open MPI; MPICH and Slurm
    if (const char* const value = std::getenv(name)) most = std::max(most, std::atoi(value));
  return most;
}

int run_program(int argc, char** argv, const JoinWorld& join) {
  prepare_streams();
  std::optional<Interruption> watch;
  try {
    watch.emplace();
  } catch (const std::bad_alloc&) {  // no memory for a message either
    std::fputs("detp: out of memory; allow more (ulimit -v)\n", stderr);
    return static_cast<int>(ExitCode::bad_input);
  } catch (const std::exception&) {
    const Failure failure = current_failure({argv, argv + argc});
    return fail(failure.code, failure.message);
  }
  Interruption& interruption = *watch;
  if (const int processes = launched_processes(); processes > 1 && !join)
    return fail(ExitCode::bad_input,
                fmt::format("{} processes were started together, but detp was built without MPI", processes));
  try {
    if (const auto world = join ? join(interruption.signal_token(), [&] { interruption.stop(); }) : nullptr)
      return run_on(*world, argc, argv, interruption);
  } catch (const std::exception& error) {
    return fail(ExitCode::internal, error.what());
  }
  return run_alone(argc, argv, interruption);
}

}  // namespace detp::cli
