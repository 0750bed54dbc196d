#include <doctest/doctest.h>

#include <algorithm>

#include "support/command.hpp"

namespace detp::support {
namespace {

const std::string in_numbers = "choose --rays 1e5 --samples 1e5 --disc-radius 0.01 --scene-side 2";
const std::string in_tree = "choose @tree --rays 20000 --disc-radius 1%";
const std::string in_cube = "choose @uniform --samples 2000 --rays 2000 --disc-radius 2%";

/// Requests of different kinds. With built-in costs, unless they give their own.
const std::vector<std::string>& short_requests() {
  static const std::vector<std::string> all{
      in_numbers,
      "choose --samples 50 --rays 1000 --disc-radius 0.01 --scene-side 2",
      "choose --samples 1 --rays 1 --disc-radius 0.01 --scene-side 2 --threads 1",
      in_numbers + " --dimension 2 --rigor structural",
      in_numbers + " --costs t=1,u=1e-12,v=1,n=1,c=1,b=1,s=1,r=1",
      in_tree,
      in_tree + " --rigor estimate",
      in_tree + " --rigor structural",
      in_tree + " --engine plain",
      in_tree + " --technique grid,octree,sphere-tree",
      in_cube,
      in_cube + " --threads 1",
      in_cube + " --rigor measure",
      in_cube + " --technique box-tree",
      "choose @cornell --rays 1000 --effects all",
      "choose @cornell --rays 1000 --light area,point,spot,directional,environment",
      "choose @caustic --rays 3000",
      "choose @interior --rays 3000 --samples 5000 --rigor measure",
      "choose @uniform --samples 2000 --rays 100 --disc-radius 8%"};
  return all;
}

bool mentions(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The first line that begins with `label`, with the lines into which it is broken; empty if there is none.
std::string line_of_label(const std::string& text, const std::string& label) {
  std::istringstream lines(text);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    if (found.empty() ? line.starts_with(label) : line.starts_with("          "))
      found += found.empty() ? line : line.substr(9);
    else if (!found.empty())
      break;
  }
  return found;
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("the text of choose has all its parts on at most 12 lines of 120 columns" * doctest::test_suite("long")) {
    for (const std::string& request : short_requests()) {
      const Finished finished = detp(request);
      const std::string& text = finished.out;
      INFO("request ", request, ", text ", text);
      CHECK(finished.code == 0);
      CHECK(std::count(text.begin(), text.end(), '\n') <= 12);
      for (const std::string label :
           {"effects   on", "choice    ", "rival     ", "tips      ", "planning  ", "costs     "})
        CHECK_FALSE(line_of_label(text, label).empty());
      CHECK((text.starts_with("scene     ") || text.starts_with("workload  ")));
      CHECK((mentions(text, "\nrays      ") || mentions(text, " rays, ")));
    }
  }

  TEST_CASE("the short text has the values of JSON: the choice with seconds and error, effects, rival and costs") {
    const Json json = result_of(in_tree);
    const std::string text = detp(in_tree).out;
    CAPTURE(text);
    const Json& choice = json.at("choice");
    const std::string line = line_of_label(text, "choice    ");
    CHECK(mentions(
        line, choice.at("technique").get<std::string>() + ", fan-out " + choice.at("parameters").at("fan_out").dump()));
    CHECK(mentions(line, fmt::format("predicted {:.3g} ± ", choice.at("predicted_seconds").get<double>())));
    const std::string effects = line_of_label(text, "effects   on");
    int off = 0;
    for (const Json& effect : json.at("effects")) {
      CHECK(mentions(effects, effect.at("name").get<std::string>()) == effect.at("on").get<bool>());
      off += effect.at("on").get<bool>() ? 0 : 1;
    }
    CHECK(mentions(effects, fmt::format("; {} off", off)));
    double least = 0;
    std::string rival;
    for (const Json& one : json.at("ruled_out"))
      if (const double seconds =
              one.contains("at_least_seconds") ? one.at("at_least_seconds") : one.at("predicted_seconds");
          rival.empty() || seconds < least) {
        least = seconds;
        rival = one.at("technique");
      }
    CHECK(mentions(text, "\nrival     " + rival + " is ruled out: "));
    CHECK(mentions(line_of_label(text, "rival     "), fmt::format("({:.3g} s)", least)));
    CHECK(mentions(line_of_label(text, "costs     "), json.at("unit_costs")));
    CHECK(mentions(line_of_label(text, "planning  "), " the predicted run): a pilot of "));
  }

  TEST_CASE("by closed forms, the text says what the error of the seconds does not cover; given costs have none") {
    CHECK(mentions(line_of_label(detp(in_numbers).out, "choice    "),
                   " s (error of unit costs; that of its closed form is not known)"));
    CHECK(
        mentions(detp(in_numbers + " --costs t=1,u=1e-12,v=1,n=1,c=1,b=1,s=1,r=1").out, " s (its error is not known)"));
    CHECK(mentions(detp(in_numbers).out, ": closed forms alone\n"));
  }

  TEST_CASE("--verbose has the candidates, what was ruled out, tips, the paper's rule, all effects and the symbols" *
            doctest::test_suite("long")) {
    for (const std::string& request : {in_tree, in_cube}) {
      const Json json = result_of(request);
      const std::string text = detp(request + " --verbose").out;
      const std::string flat = std::regex_replace(text, std::regex("\\s+"), " ");
      CAPTURE(text);
      for (const char* const label :
           {"scene     ", "rays      ", "effects   on: ", "choice    ", "rival     ", "ruled out ", "tips      ",
            "paper     its rule takes ", "planning  ", "rigor     pilot", "costs     "})
        CHECK_FALSE(line_of_label(text, label).empty());
      for (const Json& effect : json.at("effects"))
        CHECK(mentions(line_of_label(text, "effects   on: "), effect.at("name").get<std::string>()));
      for (const Json& one : json.at("ruled_out"))
        CHECK(mentions(line_of_label(text, "ruled out "), one.at("technique").get<std::string>() + " ("));
      for (const Json& one : json.at("candidates"))
        CHECK(mentions(text, fmt::format("{:.3g}", one.at("predicted_seconds").get<double>())));
      for (const char* const part :
           {" technique parameters ", "<- choice", "X: distance between neighbouring samples over d", "engine simd"})
        CHECK(mentions(flat, part));
    }
    CHECK(mentions(detp(in_tree + " --rigor estimate --verbose").out, "never chosen: "));
    CHECK_FALSE(mentions(detp(in_tree).out, "\ntechnique "));
    CHECK(detp(in_tree + " --verbose --format csv").code == 0);
  }

  TEST_CASE("texts say in words how values compare" * doctest::test_suite("long")) {
    for (const std::string& request :
         {in_numbers, in_tree, in_cube, in_tree + " --analyze", std::string("run @cornell --rays 1000"),
          std::string("scene @cornell --rays 1000")})
      for (const std::string detail : {"", " --verbose"}) {
        if (!detail.empty() && !request.starts_with("choose")) continue;
        const std::string text = detp(request + detail).out;
        CAPTURE(text);
        for (const char* const gone : {"not 1 ±", "could still win", "yes, +", "no, +", " times)"})
          CHECK_FALSE(mentions(text, gone));
      }
    CHECK(mentions(detp(in_tree + " --verbose").out, "differs from 1 by more than 0.05"));
    CHECK(mentions(detp(in_tree + " --verbose").out, ", too close to tell"));
  }

  TEST_CASE("--rigor measure without --analyze has the measured choice, whether it was predicted, and no table" *
            doctest::test_suite("long")) {
    const std::string text = detp(in_cube + " --rigor measure").out;
    CAPTURE(text);
    CHECK(mentions(line_of_label(text, "choice    "), ", the fastest of "));
    CHECK(mentions(text, "\nregret    "));
    CHECK(mentions(text, "\npredicted "));
    CHECK_FALSE(mentions(text, "\ntechnique "));
    CHECK(detp(in_cube + " --rigor measure --analyze").out.starts_with("choice    "));
  }

  TEST_CASE("a stopped choice says so first, in at most 12 lines") {
    const Finished finished = stopped_in_time(
        "choose @uniform --samples 100000 --rays 100000 --rigor measure --threads 1 --costs "
        "t=1,u=1e-18,w=1,v=1,n=1,c=1,b=1,s=1,r=1",
        [](const Finished& one) { return mentions(one.out, "\ntried     0 of "); });
    CAPTURE(finished.out);
    CHECK(finished.code == 3);
    CHECK(finished.out.starts_with("stopped   after "));
    CHECK(mentions(finished.out, "\nchoice    brute-force"));
    CHECK(std::count(finished.out.begin(), finished.out.end(), '\n') <= 12);
  }

  TEST_CASE("the default map has at most 12 lines" * doctest::test_suite("long")) {
    const std::string text = detp("choose @cornell --samples 500 --map").out;
    CAPTURE(text);
    CHECK(std::count(text.begin(), text.end(), '\n') <= 12);
    CHECK(text.starts_with("map       @cornell"));
  }
}

}  // namespace detp::support
