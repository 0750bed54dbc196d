#include <doctest/doctest.h>

#include <set>

#include "support/command.hpp"

namespace detp::support {
namespace {

struct Example {
  std::string line;
  std::vector<std::string> keys;  ///< keys that the JSON output must have, besides the envelope
};

const std::vector<Example>& examples() {
  static const std::string numbers = " --samples 1000 --rays 2000 --disc-radius 0.02 --scene-side 2";
  static const std::vector<Example> all{
      {"model" + numbers, {"form", "k", "spheres", "rebuild_time", "intersect_time", "total_time"}},
      {"model --technique octree" + numbers,
       {"depth", "cells_per_line", "discs_per_cell", "tests_per_line", "total_time"}},
      {"choose" + numbers, {"choice", "candidates", "effects", "rigor"}},
      {"run @uniform --samples 500 --rays 500",
       {"technique", "parameters", "hits", "counts", "seconds", "read_seconds"}},
      {"validate --samples 100 --rays 320", {"claims"}},
      {"scene @cornell --rays 100",
       {"triangles", "samples", "rays", "box", "sample_distance", "dimension", "effects"}}};
  return all;
}

/// The result of `validate`. Run only once, because its experiments take most of a second.
const Finished& claims() {
  static const Finished finished = detp("validate --samples 100 --rays 320 --format json --seed 7 --threads 2");
  return finished;
}

Finished json_of(const Example& example) {
  return example.line.starts_with("validate") ? claims() : detp(example.line + " --format json --seed 7 --threads 2");
}

/// True if the exit code is 0, or 1, since `validate` may find a formula refuted.
bool answered(const Finished& finished) { return finished.code == 0 || finished.code == 1; }

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("every command's help has an example, and the program's names every command") {
    const Finished program = detp("--help");
    CHECK(program.code == 0);
    CHECK(program.err.empty());
    for (const std::string name : {"model", "choose", "run", "validate", "scene", "bench"}) {
      CAPTURE(name);
      CHECK(program.out.find("\n  " + name + " ") != std::string::npos);
      const Finished help = detp(name + " --help");
      CHECK(help.code == 0);
      CHECK(help.err.empty());
      CHECK(help.out.find("Example: detp " + name + " ") != std::string::npos);
    }
  }

  TEST_CASE("help fits on a screen (40 lines of 80 columns), names options that exist, and its examples run") {
    for (const std::string name :
         {"model", "choose", "run", "validate", "scene", "bench", "calibrate", "accuracy", "report"}) {
      CAPTURE(name);
      const std::string help = detp(name + " --help").out;
      const std::string all = detp(name + " --help all").out;
      CHECK(all == detp("help " + name + " all").out);
      CHECK(std::count(help.begin(), help.end(), '\n') <= 40);
      std::istringstream lines(help);
      for (std::string line; std::getline(lines, line);) CHECK_MESSAGE(line.size() <= 80, line);
      const std::regex option("--[a-z][a-z-]*");
      for (auto found = std::sregex_iterator(help.begin(), help.end(), option); found != std::sregex_iterator();
           ++found) {
        if (found->str() == "--help") continue;
        CHECK_MESSAGE(std::regex_search(all, std::regex("\n  (-[a-z],)?" + found->str() + "[ ,\n]")), found->str());
      }
      CHECK(help.find("All options: detp " + name + " --help all\n") != std::string::npos);
      if (all.find("\n  --ray-file ") != std::string::npos)
        CHECK(all.find("rays   ox,oy,oz,dx,dy,dz") != std::string::npos);
    }
    CHECK(detp("--help all").code == 0);
  }

  TEST_CASE("--help fields explains every key of a command's JSON" * doctest::test_suite("long")) {
    const std::string numbers = " --samples 1000 --rays 2000 --disc-radius 0.02 --scene-side 2";
    for (const std::string& line :
         {"model" + numbers, "choose" + numbers, std::string("choose @cornell --rays 2000 --ranks 2"),
          std::string("choose @cornell --rays 2000 --analyze"), std::string("run @cornell --rays 2000"),
          std::string("run @cornell --target-error 60%"), std::string("run @cornell --estimator gather --paths 2"),
          "validate --experiments lines" + numbers, std::string("scene @cornell --rays 2000"),
          std::string("accuracy @cornell --target-noise 20% --effort quick"),
          std::string("bench @cornell --rays 1000 --disc-radius 4% --repeat 1 --techniques grid")}) {
      CAPTURE(line);
      const std::string help = detp(line.substr(0, line.find(' ')) + " --help fields").out;
      const Json answer = result_of(line);
      for (const auto& one : answer.items())
        if (one.key() != "schema" && one.key() != "inputs" && one.key() != "provenance" && one.key() != "stopped")
          CHECK_MESSAGE(help.find("\n  " + one.key() + " ") != std::string::npos, one.key());
    }
  }

  TEST_CASE("detp alone shows every command, a line each, and an example that works") {
    const Finished alone = detp("");
    CHECK(alone.code == 0);
    CHECK(alone.err.empty());
    for (const std::string name : {"model", "choose", "run", "validate", "scene", "bench", "calibrate"})
      CHECK(alone.out.find("\n  " + name + " ") != std::string::npos);
    CHECK(std::count(alone.out.begin(), alone.out.end(), '\n') < 15);
    const std::size_t example = alone.out.find("Example: detp ");
    REQUIRE(example != std::string::npos);
    const std::size_t from = example + std::string("Example: detp ").size();
    CHECK(detp(alone.out.substr(from, alone.out.find('\n', from) - from)).code == 0);
  }

  TEST_CASE("the help of --technique and its parameters says what run and model do without them") {
    const auto one_line = [](const std::string& help) { return std::regex_replace(help, std::regex("\\s+"), " "); };
    const std::string run = one_line(detp("help run all").out);
    const std::string model = one_line(detp("help model all").out);
    CHECK(run.find("default: chosen by a pilot; for short searches by the numbers of rays and discs") !=
          std::string::npos);
    CHECK(run.find("the fastest by the model") == std::string::npos);
    CHECK(model.find("default: the paper's rule for sphere-cache, octree and grid") != std::string::npos);
    const std::string cube = " --samples 4096 --disc-radius 0.01 --scene-side 2 ";  // 2/(2 · 0.01) = 100 > 2^6
    CHECK(result_of("model --technique octree" + cube).at("parameters").at("depth") == 6);
    CHECK(result_of("model" + cube).at("parameters").at("ratio") == 0.65);
  }

  TEST_CASE("counts may have the suffix k, M or G, in lists and ranges too") {
    const std::string numbers = "model --disc-radius 0.01 --scene-side 2 ";
    const auto inputs = [&](const std::string& options) { return result_of(numbers + options).at("inputs"); };
    CHECK(inputs("--samples 20k --rays 100k").at("rays") == 100'000);
    CHECK(inputs("--samples 20k").at("samples") == 20'000);
    CHECK(inputs("--samples 1.5k --rays 2G").at("samples") == 1'500);
    CHECK(inputs("--samples 1M --rays 2G").at("rays") == 2'000'000'000);
    CHECK(inputs("--samples 1k --rays 1k:3k:1k,0.1M").at("rays") == Json{1000, 2000, 3000, 100'000});
    CHECK(result_of("run @uniform --samples 1k --rays 2k --technique grid").at("inputs").at("rays") == 2000);
  }

  TEST_CASE("detp help shows the program's help, detp help COMMAND that of the command") {
    CHECK(detp("help").out == detp("--help").out);
    CHECK(detp("help").code == 0);
    for (const std::string name : {"model", "bench"}) {
      CHECK(detp("help " + name).out == detp(name + " --help").out);
      CHECK(detp("help " + name).code == 0);
    }
  }

  TEST_CASE("the help of each option that takes a value tells the default, except where nothing is done without it") {
    const std::set<std::string> nothing{"--checkpoint",  "--per-disc",   "--per-face",  "--pairs",       "--write-mesh",
                                        "--write-discs", "--write-rays", "--curvature", "--target-error"};
    const std::regex takes_value("^  (-[a-z],)?(--[a-z-]+) [A-Z]");
    for (const std::string name : {"model", "choose", "run", "validate", "scene", "bench"}) {
      CAPTURE(name);
      std::istringstream lines(detp("help " + name + " all").out);
      std::vector<std::string> options;
      for (std::string line; std::getline(lines, line);)
        if (line.starts_with("  -"))
          options.push_back(line);
        else if (!options.empty())
          options.back() += line;
      CHECK(options.size() > 15);
      for (const std::string& option : options) {
        CAPTURE(option);
        std::smatch found;
        if (std::regex_search(option, found, takes_value) && !nothing.contains(found[2]))
          CHECK(option.find("default: ") != std::string::npos);
      }
    }
  }

  TEST_CASE("--version prints the program and its version") {
    const Finished version = detp("--version");
    CHECK(version.code == 0);
    CHECK(version.err.empty());
    CHECK(version.out.starts_with("detp "));
    CHECK(std::count(version.out.begin(), version.out.end(), '.') == 2);
    CHECK(detp("-V").out == version.out);
    CHECK(detp("-V").code == 0);
  }

  TEST_CASE("every JSON result has schema, resolved inputs, provenance and the contract's keys") {
    for (const Example& example : examples()) {
      CAPTURE(example.line);
      const Finished finished = json_of(example);
      CHECK(answered(finished));
      CHECK(finished.err.empty());
      const Json json = finished.json();
      CHECK(json.at("schema").at("name") == "detp." + example.line.substr(0, example.line.find(' ')));
      CHECK(json.at("schema").at("version").is_number_integer());
      for (const std::string key : {"rays", "samples", "disc_radius", "sphere_radius", "scene_side", "dimension"})
        CHECK_MESSAGE(json.at("inputs").contains(key), key);
      const Json& provenance = json.at("provenance");
      CHECK(provenance.at("version").is_string());
      CHECK(provenance.at("seed") == 7);
      CHECK(provenance.at("threads") == 2);
      CHECK_FALSE(provenance.at("cpu").get<std::string>().empty());
      for (const std::string& key : example.keys) CHECK_MESSAGE(json.contains(key), key);
    }
  }

  TEST_CASE("inputs include unit costs, forms and files, so that a result can be reproduced") {
    const std::string numbers = " --samples 10 --disc-radius 0.1 --scene-side 2";
    const Json model = result_of("model --costs t=3,v=7" + numbers).at("inputs");
    CHECK(model.at("form") == "corrected");
    CHECK(model.at("levels") == 64);
    CHECK(model.at("unit_costs") == Json{{"t", 3},
                                         {"u", 0},
                                         {"w", 0},
                                         {"v", 7},
                                         {"n", 0},
                                         {"c", 0},
                                         {"b", 0},
                                         {"g", 0},
                                         {"s", 0},
                                         {"r", 0},
                                         {"l", 0},
                                         {"h", 0},
                                         {"i", 0},
                                         {"e", 0},
                                         {"m", 0},
                                         {"y", 0},
                                         {"z", 0},
                                         {"a", 0}});
    const Json choose = result_of("choose --costs t=3,u=2,w=1,v=1,n=1" + numbers).at("inputs");
    CHECK(choose.at("unit_costs").at("t") == 3);
    CHECK(choose.at("unit_costs").at("c") == 0);
    CHECK(result_of("choose" + numbers).at("inputs").at("unit_costs").at("box-tree").at("u").get<double>() < 1e-6);
    CHECK(choose.at("analyze") == false);
    const support::ScratchFolder folder;
    const std::string discs = folder.file("discs.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1,0,0,0,0,1\n");
    const std::string rays = folder.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1\n");
    const Arguments files{"--discs", discs, "--ray-file", rays, "--disc-radius", "0.5"};
    for (const std::string command : {"run", "scene", "model", "choose"}) {
      const Json inputs = result_of(Arguments{command} + files).at("inputs");
      CHECK(inputs.at("discs") == discs);
      CHECK(inputs.at("ray_file") == rays);
      CHECK_FALSE(inputs.contains("field"));
    }
    CHECK(result_of("run @uniform --rays 10 --samples 10").at("inputs").at("field") == "isotropic");
    CHECK(result_of("run @uniform --rays 10 --samples 10 --repeat 2").at("inputs").at("repeat") == 2);
  }

  TEST_CASE("text and CSV are not empty, and CSV rows have equally many fields" * doctest::test_suite("long")) {
    for (const Example& example : examples()) {
      CAPTURE(example.line);
      const Finished text = detp(example.line);
      CHECK(answered(text));
      CHECK(text.err.empty());
      CHECK(text.out.size() > 40);
      const Finished csv = detp(example.line + " --format csv");
      CHECK(answered(csv));
      CHECK(csv.err.empty());
      std::istringstream lines(csv.out);
      std::ptrdiff_t commas = -1;
      std::size_t rows = 0;
      for (std::string line; std::getline(lines, line); ++rows) {
        std::ptrdiff_t here = 0;
        bool quoted = false;
        for (const char c : line) {
          if (c == '"') quoted = !quoted;
          if (c == ',' && !quoted) ++here;
        }
        if (commas < 0) commas = here;
        CHECK_MESSAGE(here == commas, line);
      }
      CHECK(rows >= 2);
      CHECK(commas >= 1);
    }
  }

  TEST_CASE("--output writes to the file what would go to stdout, and nothing to stdout") {
    const support::ScratchFolder folder;
    const std::string path = folder.path("result");
    for (const Example& example : examples()) {
      if (example.line.starts_with("validate")) continue;  // slow, and written by the same code
      CAPTURE(example.line);
      const Finished shown = json_of(example);
      const Finished written = detp(words(example.line + " --format json --seed 7 --output") + Arguments{path});
      CHECK(written.code == shown.code);
      CHECK(written.out.empty());
      CHECK(written.err.empty());
      CHECK(without_times(Json::parse(support::content_of(path))) == without_times(shown.json()));
      CHECK(folder.entries() == 1);
    }
    const std::string model = examples().front().line;
    for (const std::string format : {"text", "csv"}) {
      CHECK(detp(words(model + " --format " + format + " --output") + Arguments{path}).code == 0);
      CHECK(support::content_of(path) == detp(model + " --format " + format).out);
    }
  }

  TEST_CASE("notices go to stderr, and --quiet suppresses them") {
    const support::ScratchFolder folder;
    const std::string mesh = folder.file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv nan 0 0\nf 1 2 3\nf 1 3 4\n");
    for (const std::string name : {"scene", "run", "choose", "model"}) {
      CAPTURE(name);
      const Arguments arguments = Arguments{name, mesh} + words("--rays 100 --disc-radius 10% --format json");
      const Finished loud = detp(arguments);
      CHECK(loud.code == 0);
      CHECK(loud.err.find("not finite") != std::string::npos);
      const Finished quiet = detp(arguments + Arguments{"--quiet"});
      CHECK(quiet.code == 0);
      CHECK(quiet.err.empty());
      CHECK(without_times(quiet.json()) == without_times(loud.json()));
    }
  }

  TEST_CASE("a claim has prediction, observation, precision and verdict") {
    const Json json = claims().json();
    REQUIRE_FALSE(json.at("claims").empty());
    for (const Json& claim : json.at("claims")) {
      CAPTURE(claim.dump());
      for (const std::string key : {"id", "source", "predicted", "observed", "standard_error", "relative_difference",
                                    "tolerance", "detectable", "verdict", "lines", "seconds"})
        CHECK_MESSAGE(claim.contains(key), key);
      const std::string verdict = claim.at("verdict");
      CHECK((verdict == "agrees" || verdict == "refuted" || verdict == "undecided"));
    }
  }
}

}  // namespace detp::support
