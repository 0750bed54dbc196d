#include <doctest/doctest.h>
#include <sys/stat.h>

#include "detp/sim/base/memory.hpp"
#include "support/attempts.hpp"
#include "support/command.hpp"

namespace detp::support {
namespace {

/// 10¹⁰ tests on one thread, which take more than 1 s.
const std::string long_run = "run @uniform --samples 100000 --rays 100000 --technique brute-force --threads 1 ";

Json check_stopped(const Finished& finished) {
  INFO("finished.err ", finished.err, ", finished.out ", finished.out);
  CHECK(finished.signal == 0);
  CHECK(finished.code == 3);
  const Json json = finished.json();
  CHECK(json.at("stopped") == true);
  CHECK(json.at("stop_seconds") >= 0);
  if (json.contains("stopped_after")) CHECK(json["stopped_after"].at("done") <= json["stopped_after"].at("of"));
  return json;
}

/// Runs all lines at the same time. Waits until every process is ready to handle signals, waits `after` more seconds,
/// and sends the signal to every process.
std::vector<Finished> interrupted(const std::vector<std::string>& lines, int signal, double after) {
  std::vector<std::unique_ptr<Process>> processes;
  for (const std::string& line : lines) processes.push_back(std::make_unique<Process>(words(line)));
  for (const auto& process : processes) process->wait_until_it_listens();
  std::this_thread::sleep_for(std::chrono::duration<double>(after));
  for (const auto& process : processes) process->send(signal);
  std::vector<Finished> finished;
  for (const auto& process : processes) finished.push_back(process->finish());
  return finished;
}

/// Until the signal came after the first counts, and before the end.
Finished interrupted_search(int signal) {
  Finished finished;
  double after = 0.1;
  static_cast<void>(in_attempts(10, [&] {
    finished = interrupted({long_run + "--format json"}, signal, after).front();
    const bool early = finished.code == 3 && !finished.json().contains("counts");
    if (early) after *= 2;
    return !early && finished.code != 0;
  }));
  return finished;
}

bool has_hits_so_far(const Finished& finished) { return finished.json().contains("hits_so_far"); }

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("Ctrl-C, a termination signal or a hangup stops a run, which shows its results and ends with code 3") {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      CAPTURE(signal);
      const Json json = check_stopped(interrupted_search(signal));
      CHECK(json.at("counts").at("disc_tests") < 1e10);
      CHECK(json.at("hits").is_null());
      CHECK(json.at("mean_irradiance").is_null());
      CHECK(json.at("hits_so_far") >= 0);
      CHECK(json.at("stopped_after").at("of") == 100'000);
    }
  }

  TEST_CASE("a hangup that was ignored when the command was started stays ignored") {
    const auto before = std::signal(SIGHUP, SIG_IGN);
    Process process(words("run @uniform --samples 1000 --rays 1000 --repeat 200 --format json"));
    std::signal(SIGHUP, before);
    for (int i = 0; i < 20; ++i) process.send(SIGHUP);
    CHECK(process.finish().code == 0);
  }

  TEST_CASE("every command can be stopped in every long phase, and reports its progress") {
    const support::ScratchFolder folder;
    const std::vector<std::string> lines{
        "run @tree --rays 1e8 --quiet",                                  // counting photon paths
        "run @cornell --rays 1e8 --field isotropic --technique octree",  // many blocks of lines
        "run @uniform --rays 1e5 --samples 1e5 --disc-radius 0.05 --technique sphere-cache --pairs " +
            folder.path("pairs.csv"),
        "scene @tree --rays 1e7 --write-rays " + folder.path("rays.csv"),  // tracing photons
        "choose @tree --rays 1e7",
        "choose @uniform --rays 2e6 --samples 1e6 --analyze",
        "choose @uniform --samples 3e6 --rigor structural",
        "model @uniform --samples 1e7 --rays 1e7",
        "validate --rays 1e8",
        "validate @uniform --samples 1e6 --rays 1e7",
        "validate --effort thorough --time-limit 3600",
        "bench @uniform --samples 1e6 --rays 1e6"};
    std::vector<std::string> as_json;
    for (const std::string& line : lines) as_json.push_back(line + " --format json");
    if (sim::memory_budget() < 2e9) {
      MESSAGE("skipped: needs 4 GB of memory");
      return;
    }
    std::vector<Finished> finished = interrupted(as_json, SIGTERM, 0.3);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      CAPTURE(lines[i]);
      if (finished[i].code == 0) finished[i] = interrupted({as_json[i]}, SIGTERM, 0.1).front();  // the signal came late
      const Json json = check_stopped(finished[i]);
      CHECK((json.contains("stopped_after") || json.contains("stopped_while")));
    }
    CHECK_FALSE(std::filesystem::exists(folder.path("pairs.csv")));
    CHECK_FALSE(std::filesystem::exists(folder.path("rays.csv")));
  }

  TEST_CASE("a stopped result is marked in text and CSV, too") {
    const Finished text =
        stopped_in_time(long_run, [](const Finished& one) { return one.out.starts_with("stopped   after "); });
    CHECK(text.code == 3);
    CHECK(text.out.starts_with("stopped   after "));
    CHECK(text.out.find("(stopped within ") != std::string::npos);
    const Finished csv = stopped_in_time(long_run + "--format csv", [](const Finished& one) {
      return one.out.find("cull_tests,") != std::string::npos;
    });
    CHECK(csv.code == 3);
    CHECK(csv.out.substr(0, csv.out.find('\n')).ends_with(",stopped_after,stopped_of,stopped_unit"));
    const Finished validate = detp("validate --rays 1e8 --threads 1 --time-limit 0.1");
    CHECK(validate.code == 3);
    CHECK(validate.out.find("no claim was judged") != std::string::npos);
    CHECK(validate.out.find("0 refuted") == std::string::npos);
  }

  TEST_CASE("a command stopped before it had any result says what it was doing, in one line") {
    const Finished finished = detp("run @tree --rays 1e8 --threads 1 --time-limit 0.02");
    CHECK(finished.code == 3);
    CHECK(finished.err.starts_with("detp: stopped while "));
    CHECK(finished.err.find('\n') + 1 == finished.err.size());
    CHECK(finished.out.find("nothing is known yet") != std::string::npos);
  }

  TEST_CASE("a stopped run leaves no partial file behind") {
    const support::ScratchFolder folder;
    const Finished finished = stopped_in_time(
        long_run + "--format json --per-disc " + folder.path("discs.csv") + " --pairs " + folder.path("pairs.csv"),
        has_hits_so_far);
    CHECK(finished.code == 3);
    CHECK(finished.err.find("not written") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder.path("discs.csv")));
    CHECK_FALSE(std::filesystem::exists(folder.path("pairs.csv")));
  }

  TEST_CASE("a second signal ends the command at once, with code 130") {
    const support::ScratchFolder folder;
    const std::string pipe =
        folder.path("pipe");  // nobody reads it, so the first signal ends the command a little later
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    CHECK(in_attempts(5, [&] {
      Process process(words("model --samples 10 --disc-radius 0.1 --scene-side 1 --output " + pipe));
      process.wait_until_it_listens();
      process.send(SIGINT);
      // A different signal, because a second SIGINT might be lost while the first is pending.
      process.send(SIGTERM);
      return process.finish().code == 130;
    }));
  }

  TEST_CASE("an output that nobody reads ends with the time limit, and with a signal" * doctest::test_suite("long")) {
    const support::ScratchFolder folder;
    const std::string unopened = folder.path("unopened");
    const std::string unread = folder.path("unread");
    for (const std::string& pipe : {unopened, unread}) REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    const int reader = ::open(unread.c_str(), O_RDWR | O_CLOEXEC);
    REQUIRE(reader >= 0);
    const auto check = [](const Finished& finished, const std::string& pipe) {
      CAPTURE(finished.err);
      CHECK(finished.code == 3);
      CHECK(finished.err.find("stopped while writing " + pipe + ": nobody reads it") != std::string::npos);
    };
    const std::string model = "model --samples 10 --disc-radius 0.1 --scene-side 1 --output " + unopened;
    for (const std::string& pipe : {unopened, unread}) {
      const std::string run = "run @cornell --rays 10k --technique box-tree --calibration none --pairs " + pipe;
      for (const std::string& line : pipe == unopened ? std::vector{model, run} : std::vector{run}) {
        CHECK(in_attempts(3, [&] {
          const Finished finished = detp(line + " --time-limit 1");
          check(finished, pipe);
          return finished.seconds < 2.5;
        }));
        Process process(words(line));
        process.wait_until_it_listens();
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        process.send(SIGTERM);
        const Finished finished = process.finish();
        if (line != model && finished.err.find("nobody reads") == std::string::npos) continue;  // still at work
        check(finished, pipe);
      }
    }
    ::close(reader);
  }

  TEST_CASE("neither signal handling nor a time limit delays the end of a command") {
    const Finished finished = detp("model --samples 10 --disc-radius 0.1 --scene-side 1 --time-limit 3600");
    CHECK(finished.code == 0);
    CHECK(finished.signal == 0);  // a command that waits is killed before
  }

  TEST_CASE("a time limit stops a run, which shows its results and ends with code 3; a longer one has no effect") {
    check_stopped(detp(long_run + "--format json --time-limit 0.2"));
    for (const char* limit : {"30", "0", "1e300"}) {
      CAPTURE(limit);
      CHECK(detp(std::string("run @uniform --samples 100 --rays 100 --time-limit ") + limit).code == 0);
    }
    for (const char* limit : {"-1", "nan", "inf"}) {
      CAPTURE(limit);
      CHECK(detp(std::string("run @uniform --samples 100 --rays 100 --time-limit ") + limit).code == 2);
    }
  }
}

}  // namespace detp::support
