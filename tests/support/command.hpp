#pragma once

#include <doctest/doctest.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "scratch_file.hpp"

/// Runs the command `detp` as a user does: as a process of its own.
namespace detp::support {

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

/// How a process ended.
struct Finished {
  int code = -1;   ///< exit code; -1 if a signal ended it
  int signal = 0;  ///< number of that signal, or 0
  std::string out;
  std::string err;
  double seconds = 0;
  double peak_bytes = 0;  ///< of memory, as the system counts it; looked at every few milliseconds

  /// The JSON result. Fails the test if stdout is not JSON.
  [[nodiscard]] Json json() const {
    const Json parsed = Json::parse(out, nullptr, false);
    REQUIRE_MESSAGE(!parsed.is_discarded(), "not JSON: ", out, err);
    return parsed;
  }
};

/// A running detp, whose stdout and stderr go to files. It is killed after half an hour: long enough for a slow and busy machine, and less
/// than what a command that hangs would take.
class Process {
 public:
  /// `addresses`, if not 0, limits the address space of the new process in bytes.
  explicit Process(const Arguments& arguments, double addresses = 0) {
    std::vector<std::string> words{DETP_COMMAND};
    if (addresses > 0) {
      const std::string limit = std::to_string(static_cast<long long>(addresses / 1024));
      words = {"/bin/sh", "-c", "ulimit -s 8192; ulimit -v " + limit + "; exec \"$0\" \"$@\"", DETP_COMMAND};
    }
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int error = posix_spawn(&id_, words[0].c_str(), &files, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) throw std::runtime_error("cannot start " + words[0]);
  }
  ~Process() {
    if (id_ > 0) (void)finish();
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const { ::kill(id_, signal); }

  /// Waits until the command handles signals. An earlier signal would just kill the process.
  void wait_until_it_listens() const {
    const std::string status = "/proc/" + std::to_string(id_) + "/status";
    while (Clock::now() - start_ < patience) {
      std::smatch blocked;
      const std::string text = support::content_of(status);
      if (std::regex_search(text, blocked, std::regex("SigBlk:\\s*([0-9a-f]+)")) &&
          (std::stoull(blocked[1], nullptr, 16) >> (SIGTERM - 1) & 1) != 0)
        return;
      if (text.find("State:\tZ") != std::string::npos) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  [[nodiscard]] bool has_ended() const {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
  }

  [[nodiscard]] Finished finish() {
    int status = 0;
    double peak_bytes = 0;
    while (::waitpid(id_, &status, WNOHANG) == 0) {
      peak_bytes = std::max(peak_bytes, peak_bytes_so_far());
      if (Clock::now() - start_ > patience) send(SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    id_ = -1;
    return {.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
            .out = support::content_of(out_),
            .err = support::content_of(err_),
            .seconds = std::chrono::duration<double>(Clock::now() - start_).count(),
            .peak_bytes = peak_bytes};
  }

 private:
  /// That of the program, not of the process from which it was forked.
  [[nodiscard]] double peak_bytes_so_far() const {
    const std::string text = support::content_of("/proc/" + std::to_string(id_) + "/status");
    const std::size_t at = text.find("VmHWM:");
    return at == std::string::npos ? 0 : 1024.0 * std::atof(text.c_str() + at + 6);
  }

  static constexpr std::chrono::seconds patience{1800};

  support::ScratchFolder folder_;
  std::string out_ = folder_.path("out");
  std::string err_ = folder_.path("err");
  Clock::time_point start_ = Clock::now();
  pid_t id_ = -1;
};

/// Splits "run @uniform" into two arguments.
inline Arguments words(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

inline Arguments operator+(Arguments left, const Arguments& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// Runs the line with a time limit of 0.1 s. Doubles the limit (up to about 200 s) until far_enough(result) is true or
/// the command ends before its limit.
template <class FarEnough>
Finished stopped_in_time(const std::string& line, const FarEnough& far_enough) {
  for (double limit = 0.1;; limit *= 2) {
    Finished finished = Process(words(line + " --time-limit " + std::to_string(limit))).finish();
    if (finished.code != 3 || far_enough(finished) || limit > 200) return finished;
  }
}

inline std::string line_of(const Arguments& arguments) {
  std::string line = "detp";
  for (const std::string& argument : arguments) line += " " + argument;
  return line;
}

inline Finished detp(const Arguments& arguments) { return Process(arguments).finish(); }
inline Finished detp(const std::string& line) { return detp(words(line)); }
inline Finished detp_in(double addresses, const std::string& line) { return Process(words(line), addresses).finish(); }

/// The JSON result of a command that must succeed.
inline Json result_of(const Arguments& arguments) {
  const Finished finished = detp(arguments + words("--format json"));
  INFO("line_of(arguments) ", line_of(arguments), ", finished.err ", finished.err);
  REQUIRE(finished.code == 0);
  return finished.json();
}
inline Json result_of(const std::string& line) { return result_of(words(line)); }

/// A command line that must be refused, and the text that the message must contain.
struct Refusal {
  Arguments arguments;
  std::string named;

  Refusal(Arguments given, std::string name) : arguments(std::move(given)), named(std::move(name)) {}
  Refusal(const std::string& line, std::string name) : Refusal(words(line), std::move(name)) {}
};

/// Fails the test unless each command is refused as the contract says: exit code 2, nothing on stdout, and on stderr
/// one line that contains `named`. Runs several commands at a time.
inline void check_refused(const std::vector<Refusal>& refusals) {
  constexpr std::size_t at_a_time = 8;
  std::vector<std::unique_ptr<Process>> processes(refusals.size());
  for (std::size_t i = 0; i < refusals.size(); ++i) {
    for (std::size_t j = i; j < std::min(i + at_a_time, refusals.size()); ++j)
      if (i % at_a_time == 0) processes[j] = std::make_unique<Process>(refusals[j].arguments);
    const Finished finished = processes[i]->finish();
    INFO("line_of(refusals[i].arguments) ", line_of(refusals[i].arguments), ", finished.err ", finished.err);
    CHECK(finished.signal == 0);
    CHECK(finished.code == 2);
    CHECK(finished.out.empty());
    CHECK(finished.err.starts_with("detp: "));
    CHECK(finished.err.find('\n') + 1 == finished.err.size());
    CHECK(finished.err.find(refusals[i].named) != std::string::npos);
  }
}

/// Whether the text contains "nan" or "inf" in place of a number, perhaps with a sign before it or an x after it.
inline bool has_no_number(const std::string& text) {
  static const std::regex no_number("(^|[^a-z])(nan|inf)(x?)($|[^a-z])", std::regex::icase);
  return std::regex_search(text, no_number);
}

/// A result without the values that differ from run to run: measured times, what follows from them, and the number of
/// threads.
inline Json without_times(const Json& json) {
  if (!json.is_structured()) return json;
  Json rest = json.is_array() ? Json::array() : Json::object();
  for (const auto& [key, value] : json.items()) {
    if (json.is_array()) {
      rest.push_back(without_times(value));
    } else if (!key.starts_with("measured_") && !key.ends_with("seconds") && key != "threads" && key != "regret" &&
               key != "choosing_share" && !key.starts_with("whole") && key != "peak_bytes_measured") {
      rest[key] = without_times(value);
    } else if (key == "predicted_seconds") {
      rest[key] = value;
    }
  }
  return rest;
}

}  // namespace detp::support
