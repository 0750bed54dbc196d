#include <doctest/doctest.h>

#include "detp/model/vocabulary/technique.hpp"
#include "support/command.hpp"

namespace detp::support {
namespace {

/// One refusal for each value: that of the line with the value at its end.
std::vector<Refusal> each(const std::string& line, const std::vector<std::string>& values, const std::string& named) {
  std::vector<Refusal> refusals;
  for (const std::string& value : values) refusals.emplace_back(words(line) + Arguments{value}, named);
  return refusals;
}

const std::string uniform = "run @uniform --samples 100 --rays 100 ";
const std::string model_numbers = "model --samples 1000 --disc-radius 0.01 --scene-side 1 ";

const std::vector<std::string> no_length{"0", "-1", "nan", "inf", "-inf", "x", "1e999"};
const std::vector<std::string> no_count{"0", "-1",  "nan", "inf",  "1.5", "1e300",
                                        "x", "10K", "k",   "1e3k", "-1k", "10kk"};

// Fewer bad values, for other options that are parsed in the same way.
const std::vector<std::string> no_length_either{"0", "nan", "1e999"};
const std::vector<std::string> no_count_either{"0", "1.5", "1e300"};

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("unknown options and names are refused, and the known ones listed") {
    check_refused(
        {{uniform + "--frob 3", "--frob"},
         {uniform + "--technique quadtree", "brute-force, sphere-cache"},
         {"run @moon", "@uniform, @tree, @tree-coarse, @courtyard, @cornell, @caustic, @interior"},
         {"scene moon", "must end in .obj, .ply, .stl, .gltf or .glb"},
         {"run @uniform @tree", "@tree"},
         {model_numbers + "--format xml", "text,json,csv"},
         {model_numbers + "--form wrong", "published,corrected"},
         {model_numbers + "--order peano", "lebesgue,hilbert,none"},
         {model_numbers + "--order hilbert", "Hilbert curve"},
         {model_numbers + "--technique octree --traversal neighbour-links", "no closed form"},
         {model_numbers + "--technique bsp", "no closed form of bsp"},
         {uniform + "--technique octree --traversal sideways", "top-down,front-to-back,restart,neighbour-links"},
         {uniform + "--field sound", "isotropic,photons"},
         {"choose @uniform --rigor guess", "estimate, structural, pilot or measure"},
         {"choose --rigor pilot --rays 10 --samples 10 --disc-radius 0.1 --scene-side 1", "needs rays"},
         {uniform + "--technique", "--technique"}});
  }

  TEST_CASE("for an unknown name that is near a known one, that one is suggested") {
    check_refused({{"chose @tree", "did you mean choose?"},
                   {"help chose", "did you mean choose?"},
                   {"run @uniform --ryas 10", "did you mean --rays?"},
                   {"run @uniform --disc-raduis=10", "did you mean --disc-radius?"},
                   {uniform + "--technique octre", "did you mean octree?"},
                   {uniform + "--technique grid,boxtree", "did you mean box-tree?"},
                   {uniform + "--field photon", "did you mean photons?"},
                   {"bench --techniques gird", "did you mean grid?"},
                   {"run @treee", "did you mean @tree?"}});
  }

  TEST_CASE("a name that is near none is refused without a suggestion") {
    for (const std::string line : {"frobnicate", "run @uniform --frobnicate 3", "run @moonshine"})
      CHECK(detp(line).err.find("did you mean") == std::string::npos);
  }

  TEST_CASE("a workload without a scene needs samples, a disc radius and a size; the message says which is missing") {
    for (const std::string command : {"model", "choose", "run", "scene"})
      check_refused(
          {{command, "a scene is needed (a mesh, or a built-in one as @tree); or --discs FILE and --ray-file FILE"},
           {command + " --rays 5", "or numbers: --samples N --disc-radius d --scene-side s"},
           {command + " --disc-radius 1", "--samples"},
           {command + " --samples 10", "--disc-radius"},
           {command + " --samples 10 --disc-radius 1", "--sphere-radius"}});
  }

  TEST_CASE("counts are whole numbers of at least 1") {
    check_refused(each("model --disc-radius 0.01 --scene-side 1 --samples", no_count, "samples"));
    check_refused(each(model_numbers + "--rays", no_count_either, "rays"));
    check_refused(each("run @uniform --samples 100 --rays", no_count_either, "rays"));
    check_refused(each("run @uniform --rays 100 --samples", no_count_either, "samples"));
    check_refused(each("validate --rays", no_count_either, "rays"));
    check_refused(each(uniform + "--repeat", {"-1", "1.5", "nan", "1e300", "99999"}, "--repeat"));
    check_refused(each(uniform + "--threads", {"-1", "1.5", "nan", "1e9"}, "--threads"));
    check_refused(each(model_numbers + "--levels", {"-1", "1.5", "nan", "10000000"}, "--levels"));
  }

  TEST_CASE("lengths are positive and finite") {
    check_refused(each("model --samples 10 --scene-side 1 --disc-radius", no_length, "disc"));
    check_refused(each("model --samples 10 --scene-side 1 --disc-radius", {"0%", "-1%", "nan%", "%", "5%%"}, "disc"));
    check_refused(each("run @uniform --samples 10 --rays 10 --disc-radius", no_length_either, "disc"));
    check_refused(each("model --samples 10 --disc-radius 0.1 --scene-side", no_length_either, "side"));
    check_refused(each("model --samples 10 --disc-radius 0.1 --sphere-radius", no_length_either, "radius"));
    check_refused(each(model_numbers + "--sample-extent", no_length_either, "extent"));
    check_refused(each(model_numbers + "--dimension", {"0", "0.9", "3.1", "nan", "inf", "-1", "x"}, "dimension"));
  }

  TEST_CASE("parameters of techniques out of range are refused") {
    const std::vector<std::string> no_ratio{"0", "1", "1.5", "-0.5", "nan", "inf", "x"};
    check_refused(each(model_numbers + "--ratio", no_ratio, "ratio"));
    check_refused(each(uniform + "--technique sphere-cache --ratio", {"0", "1", "nan"}, "ratio"));
    check_refused(each(uniform + "--technique sphere-cache --spheres", {"-1", "1e19", "1.5", "nan"}, "spheres"));
    check_refused(each(uniform + "--technique octree --depth", {"-1", "21", "99", "1.5", "nan"}, "depth"));
    check_refused(each(uniform + "--technique bsp --depth", {"-1", "65"}, "depth"));
    check_refused(each(uniform + "--technique bsp --leaf", {"0", "1.5"}, "leaf"));
    check_refused(each(uniform + "--technique grid --cells", {"0", "-1", "1e9", "1000000000", "nan"}, "cells"));
    for (const std::string& command : {uniform, model_numbers}) {
      check_refused(each(command + "--technique cell-spheres --depth", {"-1", "17"}, "depth"));
      check_refused(each(command + "--technique sphere-tree --fan-out", {"1", "1.5"}, "fan-out"));
      check_refused(each(command + "--technique sphere-tree --leaf", {"0", "-1"}, "leaf"));
    }
    check_refused(each(model_numbers + "--technique octree --depth", {"-1", "999", "1.5"}, "depth"));
    check_refused(each(model_numbers + "--technique grid --cells", {"0", "-1", "2.5"}, "cells"));
    if (detp::has_embree) check_refused(each(uniform + "--technique bvh --quality", {"high", "Low", "1"}, "quality"));
    check_refused(each(uniform + "--technique photon-map --nearest", {"2", "1.5"}, "nearest"));
    check_refused({{model_numbers + "--technique bsp", "no closed form of bsp"},
                   {model_numbers + "--technique photon-map", "no closed form of photon-map"},
                   {uniform + "--technique photon-map", "no ray met one"},
                   {"run @cornell --rays 20 --technique photon-map", "needs the 50 nearest photons"}});
    for (const std::string technique : {"grid", "cell-spheres", "sphere-tree"})
      check_refused({{model_numbers + "--form published --technique " + technique, "--form corrected"}});
  }

  TEST_CASE("parameters of other techniques are refused and not ignored") {
    for (const std::string& command : {uniform, model_numbers})
      check_refused({{command + "--technique sphere-cache --depth 3", "--depth"},
                     {command + "--technique sphere-cache --cells 3", "--cells"},
                     {command + "--technique octree --ratio 0.5", "--ratio"},
                     {command + "--technique octree --cells 3", "--cells"},
                     {command + "--technique grid --depth 3", "--depth"},
                     {command + "--technique grid --spheres 3", "--spheres"},
                     {command + "--technique octree --fan-out 3", "--fan-out"},
                     {command + "--technique grid --traversal restart", "--traversal"},
                     {command + "--technique cell-spheres --leaf 3", "--leaf"},
                     {command + "--technique sphere-tree --depth 3", "--depth"},
                     {command + "--technique grid --quality low", "--quality"},
                     {command + "--technique bsp --nearest 9", "--nearest"},
                     {command + "--technique brute-force --ratio 0.5", "--ratio"},
                     {command + "--technique brute-force --order none", "--order"}});
  }

  TEST_CASE("options that do not go together are refused") {
    check_refused({{"run @cornell --sphere-radius 3", "--sphere-radius"},
                   {"run @cornell --scene-side 3", "--scene-side"},
                   {uniform + "--field photons", "light"},
                   {"run --samples 10 --disc-radius 0.1 --scene-side 1 --field photons", "scene"},
                   {"validate @uniform --field photons", "light"}});
  }

  TEST_CASE("unit costs are pairs of a known name and a number of at least 0") {
    for (const std::string& command :
         {model_numbers, std::string("choose --samples 10 --disc-radius 0.1 --scene-side 1 ")})
      check_refused({{command + "--costs garbage", "name=value"},
                     {command + "--costs t", "name=value"},
                     {command + "--costs x=1", "\"x\""},
                     {command + "--costs t=", "unit cost t"},
                     {command + "--costs t=one", "unit cost t"},
                     {command + "--costs t=1;u=2", "unit cost t"},
                     {command + "--costs u=-1", "unit cost u"},
                     {command + "--costs u=nan", "unit cost u"},
                     {command + "--costs u=inf", "unit cost u"},
                     {command + "--costs u=0x1", "unit cost u"},
                     {command + "--costs t=1,", "name=value"},
                     {command + "--costs t=1,t=2", "unit cost t is given twice"},
                     {command + "--costs t=1,u=1,t=1", "unit cost t is given twice"}});
  }

  TEST_CASE("work that would not fit in memory is refused before it is tried") {
    check_refused({{"run @cornell --rays 1e12", "GB"},
                   {"run @uniform --samples 1e12", "GB"},
                   {"scene @cornell --samples 1e12", "GB"},
                   {"choose @cornell --rays 1e17 --analyze", "GB"},
                   {uniform + "--technique grid --cells 1000000", "GB"}});
  }

  TEST_CASE("an unknown command is named, and so is an option without a command") {
    check_refused({{"--seed 1", "--seed"}, {"quux", "quux"}, {"quux --rays 5", "quux"}, {"--format json", "--format"}});
  }

  TEST_CASE("a number is decimal and stands alone, for every option") {
    check_refused(each("run @uniform --rays",
                       {"0x10", "inf", "-nan", " 5", "5 ", "+5", "1e400", "1e-400", "1_000", "five", "1e3x", "."},
                       "--rays"));
    check_refused(each("choose --disc-radius 0.1 --rays", {"5,6", "5:6:1"}, "--rays"));
    const std::vector<std::string> no_number{"0x10", "inf"};
    for (const std::string option : {"--samples", "--sphere-radius", "--dimension", "--sample-extent"})
      check_refused(each("choose --disc-radius 0.1 " + option, no_number, option));
    for (const std::string option : {"--samples", "--ratio", "--spheres", "--depth", "--cells", "--leaf", "--fan-out",
                                     "--nearest", "--time-limit", "--threads", "--repeat"})
      check_refused(each("run @uniform " + option, no_number, option));
    check_refused(each("run @uniform --disc-radius", no_number, "disc radius"));
    check_refused(each("bench @uniform --rays", no_number, "--rays"));
    check_refused(each("bench @uniform --most-hits", no_number, "--most-hits"));
    check_refused(each("validate --effort thorough --most-samples", no_number, "--most-samples"));
    check_refused(each(model_numbers + "--levels", no_number, "--levels"));
    CHECK(result_of(model_numbers + "--seed 010").at("provenance").at("seed") == 10);
    CHECK(result_of(model_numbers + "--rays 1e3").at("inputs").at("rays") == 1000);
    CHECK(result_of(model_numbers + "--technique grid --cells 2e1").at("parameters").at("cells") == 20);
  }

  TEST_CASE("ranges have a start, an end and a step; tables have at most 20 000 rows") {
    check_refused({{model_numbers + "--ratio 0.3:0.9", "start:end:step"},
                   {model_numbers + "--ratio 0.3:0.9:0.1:2", "start:end:step"},
                   {model_numbers + "--ratio 0.3:0.9:0", "start:end:step"},
                   {model_numbers + "--ratio 0.9:0.3:0.1", "start:end:step"},
                   {model_numbers + "--ratio 0.3::0.1", "--ratio"},
                   {model_numbers + "--ratio 0.3:x:0.1", "--ratio"},
                   {model_numbers + "--ratio 0.3:0.9:1e-9", "at most 20000"},
                   {model_numbers + "--ratio 0.1:0.9:0.001 --rays 1e3:1e6:1e3", "at most 20000"},
                   {model_numbers + "--ratio 0.3,", "--ratio"},
                   {model_numbers + "--ratio 0.5,1.5", "ratio"},
                   {model_numbers + "--form published,wrong", "published,corrected"},
                   {"model --samples 10 --scene-side 1 --disc-radius 1%:4:1%", "start:end:step"},
                   {"choose --samples 10 --disc-radius 0.1 --scene-side 1 --rays 1e3,1e4", "--rays"},
                   {uniform + "--standard-error", "--per-disc"},
                   {uniform + "--technique grid --cells 4,8 --per-disc x.csv", "--per-disc"}});
  }

  TEST_CASE("a seed is a whole number below 2^64; anything else is refused") {
    check_refused(each(model_numbers + "--seed", {"-1", "1.5", "nan", "x", "1e3", "18446744073709551616"}, "--seed"));
    CHECK(result_of(model_numbers + "--seed 18446744073709551615")["provenance"]["seed"] == UINT64_MAX);
  }

  TEST_CASE("a time limit is a finite number of seconds from 0; a very long one has no effect") {
    check_refused(each(uniform + "--time-limit", {"-1", "nan", "inf", "x"}, "--time-limit"));
    CHECK(
        result_of("run @uniform --samples 20000 --rays 20000 --technique brute-force --time-limit 1e300")["stopped"] ==
        false);
  }

  TEST_CASE("an empty value is refused, not treated as absent") {
    for (const std::string option : {"--rays", "--samples", "--disc-radius", "--sample-extent", "--output", "--costs"})
      check_refused({{words(model_numbers) + Arguments{option, ""}, option}});
    check_refused({{Arguments{"run", ""}, "argument 2 is empty"}});
  }
}

}  // namespace detp::support
