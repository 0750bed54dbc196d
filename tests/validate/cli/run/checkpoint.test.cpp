#include <doctest/doctest.h>

#include <cstdlib>
#include <random>

#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "support/run_support.hpp"
#include "support/sealed.hpp"

namespace detp::support {
namespace {

/// What is left of a result without times.
Json without_times(Json json) {
  if (json.is_object()) {
    for (auto it = json.begin(); it != json.end();)
      it = it.key().find("seconds") != std::string::npos || it.key().ends_with("_measured") ? json.erase(it)
                                                                                            : std::next(it);
  }
  if (json.is_structured())
    for (auto& part : json) part = without_times(part);
  return json;
}

/// What must be the same. Of `accuracy`, whose points depend on seconds, the runs.
Json result_without_times(const Finished& finished) {
  const Json json = finished.json();
  return without_times(json.contains("reruns") ? json.at("reruns") : json);
}

/// A checkpoint of accuracy that has the pilot. What accuracy runs depends on the seconds of its pilot, so all runs begin with the same.
std::string checkpoint_with_pilot(const std::string& command, const ScratchFolder& folder) {
  const std::string path = folder.path("pilot.json");
  const auto with_pilot = [&](const Finished&) {
    const std::string content = content_of(path);
    return !content.empty() && !Json::parse(content).at("state").at("pilot").is_null();
  };
  const Finished stopped = stopped_in_time(command + " --checkpoint " + path, with_pilot);
  REQUIRE(with_pilot(stopped));
  return content_of(path);
}

/// Kills the command at random moments and continues it from its checkpoint, until it has been killed so often.
void check_killed_runs(const std::string& command, int kills) {
  CAPTURE(command);
  const ScratchFolder folder;
  const std::string output = folder.path("output.csv");
  const std::string checkpoint = folder.path("checkpoint.json");
  const bool runs = command.starts_with("run");
  const std::string whole = command + " --format json " + (runs ? "--calibration none --per-disc " + output : "");
  const std::string resumed = whole + " --resume --checkpoint " + checkpoint;
  const std::string first = command.starts_with("accuracy") ? checkpoint_with_pilot(whole, folder) : "";
  const auto begin_anew = [&] {
    std::filesystem::remove(checkpoint);
    if (!first.empty()) static_cast<void>(folder.file("checkpoint.json", first));
  };
  begin_anew();
  const Finished once = detp(first.empty() ? whole : resumed);
  REQUIRE(once.code == 0);
  const std::string bytes = content_of(output);
  const Json result = result_without_times(once);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> moment(0, 1.1 * once.seconds);
  int went_on = 0;  // runs that found a checkpoint of a run before
  begin_anew();
  for (int kill = 0; kill < kills;) {
    std::filesystem::remove(output);
    const std::string before = content_of(checkpoint);
    went_on += before != first ? 1 : 0;
    Process process(words(resumed));
    if (kill % 2 == 0)  // soon after its first checkpoint, else at any moment
      while (!process.has_ended() && content_of(checkpoint) == before)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::duration<double>(moment(random) / (kill % 2 == 0 ? 10 : 1)));
    process.send(SIGKILL);
    const Finished finished = process.finish();
    if (finished.signal == SIGKILL) {
      ++kill;
      if (kill < kills) continue;
    }
    const Finished last = finished.code == 0 ? finished : detp(resumed);
    CAPTURE(last.err);
    REQUIRE(last.code == 0);
    CHECK(result_without_times(last) == result);
    CHECK(content_of(output) == bytes);
    begin_anew();
  }
  CHECK(went_on > kills / 4);
}

/// DETP_KILLS, else 5.
int kills() {
  const char* text = std::getenv("DETP_KILLS");
  return text == nullptr ? 5 : std::atoi(text);
}

}  // namespace

TEST_SUITE("kills") {
  TEST_CASE("work that is killed at any moment and continued finds the same") {
    check_killed_runs("run @cornell --target-noise 6% --technique box-tree --threads 1", kills());
    check_killed_runs("run @cornell --field isotropic --target-noise 5% --technique octree --threads 2", kills());
    check_killed_runs("validate --rays 20k --samples 300 --disc-radius 4% --until-relative-error 10% --threads 2",
                      kills());
    check_killed_runs("accuracy @cornell --target-noise 10% --estimators disc --seeds 1:20 --threads 2", kills());
  }
}

TEST_SUITE("end to end") {
  TEST_CASE("pilots that were stopped before they knew enough are made again, not kept" * doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string checkpoint = folder.path("checkpoint.json");
    const std::string command = "accuracy @cornell --target-error 1% --format json --checkpoint " + checkpoint;
    const Finished stopped = stopped_in_time(command, [](const Finished& one) {
      return one.code == 3 && one.out.find("predicted_seconds") != std::string::npos &&
             one.json()["stopped_after"]["done"] == 1;
    });
    REQUIRE(stopped.json()["stopped_after"]["done"] == 1);
    CHECK(Json::parse(content_of(checkpoint)).at("state").at("pilot").is_null());
  }

  TEST_CASE("a run that was stopped goes on; checkpoints of other runs, damaged ones and wrong options are refused" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string checkpoint = folder.path("checkpoint.json");
    std::string run;
    std::string content;
    for (const char* noise :
         {"5%", "3%", "2%", "1%"}) {        // whatever a fast machine does not reach before its first checkpoint
      std::filesystem::remove(checkpoint);  // that of a run before
      run = std::string(
                "run @cornell --technique box-tree --calibration none --threads 1 --format json --target-noise ") +
            noise + " ";
      const Finished stopped = stopped_in_time(run + "--checkpoint " + checkpoint, [&](const Finished& one) {
        return one.code == 3 && !content_of(checkpoint).empty();
      });
      content = content_of(checkpoint);
      if (stopped.code == 3) break;
    }
    REQUIRE_FALSE(content.empty());
    CHECK(detp(run + "--resume --checkpoint " + checkpoint).code == 0);
    CHECK(detp(run + "--resume --checkpoint " + folder.path("none.json")).code == 0);
    const auto resumed = [&](const std::string& text, const std::string& named) {
      static int number = 0;
      const std::string path = folder.path("file" + std::to_string(++number));
      std::ofstream(path) << text;
      return Refusal(run + "--resume --checkpoint " + path, named);
    };
    const auto replaced = [&](const char* what, const char* by) {
      return std::regex_replace(content, std::regex(what), by);
    };
    const std::string other = sealed_checkpoint(Json::parse(replaced("\"run until an error\"", "\"validate\"")));
    const std::string fewer = sealed_checkpoint(Json::parse(replaced("\"sums\":\\[[^,]*,", "\"sums\":[")));
    const std::string altered = replaced("(\"sums\":\\[[0-9.]*)[0-4]", "$017");
    check_refused({resumed(content.substr(0, content.size() / 2), "is not a checkpoint"),
                   resumed(other, "is a checkpoint of \"validate\""),
                   resumed(fewer, "another number of discs"),
                   resumed(altered, "does not fit its checksum"),
                   {run + "--seed 2 --resume --checkpoint " + checkpoint, "was made with seed 1, not 2"},
                   {run + "--disc-radius 3% --resume --checkpoint " + checkpoint, "digest of rays and discs"},
                   {run + "--resume", "--checkpoint"},
                   {"run @cornell --checkpoint " + checkpoint, "--target-noise"},
                   {run + "--checkpoint " + folder.path("missing/c"), "cannot be written"}});
  }
}

TEST_SUITE("end to end") {
  TEST_CASE("a resumed run keeps the technique of its checkpoint, unless another one is asked for by name" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string checkpoint = folder.path("checkpoint.json");
    const auto calibration = [&](const std::string& name, double factor) {  // of the tests of rays with discs
      validate::Calibration made;
      made.plain = validate::built_in_unit_costs(Engine::plain);
      made.simd = validate::built_in_unit_costs();
      for (const Technique technique : all_techniques) made.simd[technique].disc_test *= factor;
      validate::write_calibration(folder.path(name), made);
      return " --calibration " + folder.path(name);
    };
    const std::string cheap = calibration("cheap.json", 0.01);
    const std::string dear = calibration("dear.json", 100);
    const std::string common = "run @cornell --field isotropic --threads 1";
    REQUIRE(result_of(common + " --technique box-tree" + cheap)["parameters"] !=
            result_of(common + " --technique box-tree" + dear)["parameters"]);
    for (const std::string& asked : {std::string(" --technique box-tree"), std::string()}) {
      CAPTURE(asked);
      std::string run;
      for (const char* noise : {"5%", "3%", "2%", "1%", "0.5%"}) {
        std::filesystem::remove(checkpoint);
        run = common + " --target-noise " + noise;
        const Finished stopped = stopped_in_time(run + asked + cheap + " --format json --checkpoint " + checkpoint,
                                                 [&](const Finished&) { return !content_of(checkpoint).empty(); });
        if (stopped.code == 3) break;
      }
      const Json kept = Json::parse(content_of(checkpoint)).at("state");
      const std::string before = content_of(checkpoint);
      const std::string technique = kept.at("technique");
      const std::string resume = dear + " --resume --checkpoint " + checkpoint;
      const std::string other = technique == "octree" ? "grid" : "octree";
      check_refused({{run + " --technique " + other + resume, ", not " + other},
                     {run + " --technique " + technique + " --leaf 77" + resume, ", not leaf 77"}});
      CHECK(content_of(checkpoint) == before);
      const Json resumed = result_of(run + asked + resume);
      CHECK(resumed.at("technique") == technique);
      CHECK(resumed.at("parameters") == kept.at("parameters"));
    }
  }
}

}  // namespace detp::support
