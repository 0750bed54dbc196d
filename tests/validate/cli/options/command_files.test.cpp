#include <doctest/doctest.h>

#include <filesystem>

#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "support/command.hpp"

namespace detp::support {
namespace {

/// Files as a user has them.
struct UsersFiles {
  ScratchFolder folder;
  std::string materials = folder.file("room.mtl", "newmtl lamp\nKe 1 1 1\nnewmtl wall\nKd 0.5 0.5 0.5\n");
  std::string mesh = folder.file("room.obj",
                                 "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl lamp\nf 1 2 3\n"
                                 "usemtl wall\nf 1 2 4\n");
  std::string discs = folder.file("discs.csv", "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,0.1\n");
  std::string rays = folder.file("rays.csv", "ox,oy,oz,dx,dy,dz,length,power\n0,0,1,0,0,-1,2,1\n");
  std::string calibration = folder.path("costs.json");

  UsersFiles() {
    validate::Calibration made;
    made.plain = validate::built_in_unit_costs(Engine::plain);
    made.simd = validate::built_in_unit_costs();
    validate::write_calibration(calibration, made);
  }

  [[nodiscard]] std::vector<std::string> contents() const {
    std::vector<std::string> all;
    for (const std::string& path : {materials, mesh, discs, rays, calibration}) all.push_back(content_of(path));
    return all;
  }
};

/// Other spellings of a path, and other names of its file.
std::vector<std::string> spellings(const std::string& path, const ScratchFolder& folder) {
  const std::string name = std::filesystem::path(path).filename();
  const std::string ending = std::filesystem::path(path).extension();
  static int number = 0;
  const std::string each = std::to_string(++number) + ending;
  std::filesystem::create_symlink(name, folder.path("link" + each));
  std::filesystem::create_symlink("link" + each, folder.path("second" + each));
  std::filesystem::create_hard_link(path, folder.path("hard" + each));
  return {path, folder.path("./" + name), folder.path("link" + each), folder.path("second" + each),
          folder.path("hard" + each)};
}

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("an output onto an input is refused before any work, by whatever path, and the input stays") {
    const UsersFiles files;
    const std::vector<std::string> before = files.contents();
    const std::string data = "run --discs " + files.discs + " --ray-file " + files.rays;
    const std::string scene = "scene " + files.mesh;
    std::vector<Refusal> refusals;
    for (const std::string& path : spellings(files.discs, files.folder)) {
      for (const char* option : {" -o ", " --per-disc ", " --pairs "})
        refusals.push_back({data + option + path, "the file of --discs"});
      refusals.push_back({"scene --discs " + files.discs + " --ray-file " + files.rays + " --write-discs " + path,
                          "the file of --discs"});
    }
    for (const std::string& path : spellings(files.rays, files.folder)) {
      refusals.push_back({data + " --per-disc " + path, "the file of --ray-file"});
      refusals.push_back({scene + " --ray-file " + files.rays + " --write-rays " + path, "the file of --ray-file"});
    }
    for (const std::string& path : spellings(files.calibration, files.folder))
      refusals.push_back({data + " --calibration " + files.calibration + " -o " + path, "the file of --calibration"});
    const std::string mesh = files.folder.path("mesh");  // a suffix that no output has would be refused for itself
    std::filesystem::create_symlink("room.obj", mesh);
    refusals.push_back({scene + " --write-mesh " + mesh, "the file of SCENE"});
    refusals.push_back({"run " + files.mesh + " --per-disc " + mesh, "the file of SCENE"});
    const std::string materials = files.folder.path("materials");
    std::filesystem::create_hard_link(files.materials, materials);
    for (const char* option : {" --write-mesh ", " --write-discs ", " --write-rays ", " -o "})
      refusals.push_back({scene + option + materials, "a part of " + files.mesh});
    refusals.push_back({"accuracy " + files.mesh + " --reference " + materials, "a part of"});
    refusals.push_back(
        {"run " + files.mesh + " --target-noise 5% --checkpoint " + materials, "a part of " + files.mesh});
    check_refused(refusals);
    CHECK(files.contents() == before);
  }

  TEST_CASE("an answer that is added to an input is refused, and a pipe may be input and output") {
    const UsersFiles files;
    const std::string run = std::string(DETP_COMMAND) + " run --calibration none --technique brute-force --ray-file " +
                            files.rays + " --discs ";
    const std::string before = content_of(files.discs);
    CHECK(std::system((run + files.discs + " >>" + files.discs + " 2>/dev/null").c_str()) != 0);
    CHECK(content_of(files.discs) == before);
    CHECK(std::system(("cat " + files.discs + " | " + run + "/dev/stdin | grep -q hits").c_str()) == 0);
  }

  TEST_CASE("a stored calibration is not replaced by a result, but by one that calibrate saves by that name" *
            doctest::test_suite("long")) {
    const UsersFiles files;
    std::filesystem::create_directories(files.folder.path("cache/detp"));
    const std::string stored = files.folder.path("cache/detp/calibration.json");
    std::filesystem::copy_file(files.calibration, stored);
    ::setenv("XDG_CACHE_HOME", files.folder.path("cache").c_str(), 1);
    check_refused({{"choose @uniform --rays 100 --samples 100 -o " + stored, "would replace " + stored},
                   {"run @uniform --rays 100 --samples 100 -o " + stored, "the stored calibration"}});
    CHECK(detp("calibrate --seconds 0.1 --quiet -o " + stored).code == 0);
    ::setenv("XDG_CACHE_HOME", "/dev/null", 1);
    CHECK(content_of(stored) != content_of(files.calibration));
  }

  TEST_CASE("the suffix of an output decides its format, and others are refused before any work") {
    const ScratchFolder folder;
    const std::string run = "run @uniform --samples 100 --rays 100 --technique brute-force ";
    const std::string scene = "scene @cornell --rays 100 ";
    std::vector<Refusal> refusals;
    for (const char* name : {"x.xyz", "x.obj", "x.doc", "x.json.gz"}) {
      refusals.push_back({run + "--per-disc " + folder.path(name), "writes .csv, .ply, .vtp, .npy"});
      refusals.push_back({run + "--per-face " + folder.path(name), "writes .csv, .ply, .vtp, .npy"});
      refusals.push_back({run + "--pairs " + folder.path(name), "writes .csv"});
      refusals.push_back({run + "-o " + folder.path(name), "writes .txt, .json, .csv"});
    }
    for (const char* name : {"x.xyz", "x.obj", "x.csv.bak"}) {
      refusals.push_back({scene + "--write-mesh " + folder.path(name), "writes .ply"});
      refusals.push_back({scene + "--write-discs " + folder.path(name), "writes .csv, .ply"});
      refusals.push_back({scene + "--write-rays " + folder.path(name), "writes .csv, .ply"});
    }
    refusals.push_back({"run --discs - --ray-file -", "only one input can be standard input"});
    refusals.push_back({run + "--format csv -o " + folder.path("x.json"), "--format csv contradicts"});
    refusals.push_back({run + "--format json -o " + folder.path("x.csv"), "--format json contradicts"});
    refusals.push_back({run + "--format json -o " + folder.path("x.svg"), "--format json contradicts"});
    refusals.push_back({"choose @tree -o " + folder.path("x.svg"), "writes .txt, .json, .csv"});
    refusals.push_back({"report @cornell -o " + folder.path("x.pdf"), "writes .html, .htm"});
    refusals.push_back({"calibrate -o " + folder.path("x.csv"), "writes .json"});
    refusals.push_back({"accuracy @cornell --reference " + folder.path("x.ply"), "not .ply"});
    refusals.push_back({"accuracy @cornell --checkpoint " + folder.path("x.csv"), "not .csv"});
    check_refused(refusals);
    CHECK(folder.entries() == 0);
    for (const char* name : {"a.json", "A.JSON"}) {
      REQUIRE(detp(run + "-o " + folder.path(name)).code == 0);
      CHECK(Json::parse(content_of(folder.path(name))).at("technique") == "brute-force");
    }
    for (const char* name : {"a.csv", "tmp.Q2xJmC7d9k", "run-0.5"}) {
      const bool csv = std::string(name).ends_with("csv");
      REQUIRE(detp(run + "-o " + folder.path(name)).code == 0);
      CHECK(content_of(folder.path(name)).starts_with(csv ? "scene," : "scene "));
    }
    REQUIRE(detp(run + "--format csv -o " + folder.path("a.txt")).code == 0);
    CHECK(content_of(folder.path("a.txt")).starts_with("scene,"));
  }

  TEST_CASE("--checkpoint without --resume replaces checkpoints only" * doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string run = "run @cornell --target-noise 20% --rays 100k --calibration none ";
    const std::string validate = "validate --rays 1k --samples 100 --disc-radius 4% --until-relative-error 50% ";
    const std::string accuracy = "accuracy @cornell --target-noise 20% --estimators disc --effort quick ";
    std::vector<Refusal> refusals;
    for (const std::string content : {"my notes", "{}", R"({"schema":{"name":"other"}})"}) {
      const std::string file = folder.file("file" + std::to_string(folder.entries()), content);
      for (const std::string& command : {run, validate, accuracy})
        refusals.push_back({command + "--checkpoint " + file, "would be replaced, but is not a checkpoint"});
    }
    check_refused(refusals);
    CHECK(content_of(folder.path("file0")) == "my notes");
    for (const std::string& command : {run, validate, accuracy}) {
      const std::string checkpoint = folder.file("mine", "");  // empty, as mktemp makes it
      CHECK(detp(command + "--checkpoint " + checkpoint).code == 0);
      validate::CheckpointFile(checkpoint, "other work", {{"seed", 7}}).write({});
      const std::string before = content_of(checkpoint);
      check_refused({{command + "--resume --checkpoint " + checkpoint, "is a checkpoint of \"other work\""}});
      CHECK(content_of(checkpoint) == before);
      CHECK(detp(command + "--checkpoint " + checkpoint).code == 0);
    }
  }

  TEST_CASE("unknown lights and directions, and lights for lines or for rays from a file, are refused") {
    const auto refuses = [](const std::string& line, const std::string& message) {
      CAPTURE(line);
      const Finished finished = detp(words(line));
      CHECK(finished.code == 2);
      CHECK(finished.err.find(message) != std::string::npos);
    };
    refuses("run @cornell --light lamp", "--light must be one of");
    refuses("run @cornell --light area,", "--light must be one of");
    refuses("run @cornell --up w", "--up must be one of");
    refuses("run @cornell --light surface", "no triangle of @cornell emits light");
    refuses("run @cornell --field mixed:1:2", "three shares");
    refuses("run @cornell --field mixed::",
            "a mixture is mixed, or mixed:ISOTROPIC:DIRECTIONAL:POINT with three shares");
    refuses("run @cornell --field mixed:", "three shares");
    refuses("run @cornell --field mixed:0.5:0.2:0.2", "must add up to 1");
    refuses("run @cornell --field mixed --light spot", "these are a mixed field");
    refuses("run @uniform --light area", "--light and --up are for photon paths; these are isotropic lines");
    refuses("run @cornell --field isotropic --up z", "--light and --up are for photon paths");
    const ScratchFolder folder;
    const std::string rays = folder.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,1,0,0\n");
    refuses("run @cornell --light area --ray-file " + rays, "these are rays from a file");
  }
}

TEST_SUITE("end to end") {
  TEST_CASE("discs and rays are written as CSV or PLY by their suffix, and a run of either finds the same") {
    const ScratchFolder folder;
    std::vector<std::string> found;
    for (const char* ending : {".csv", ".ply"}) {
      const std::string discs = folder.path(std::string("discs") + ending);
      const std::string rays = folder.path(std::string("rays") + ending);
      REQUIRE(detp("scene @cornell --rays 2000 --quiet --write-discs " + discs + " --write-rays " + rays).code == 0);
      CHECK(content_of(discs).starts_with(std::string(ending) == ".ply" ? "ply\nformat binary" : "x,y,z,"));
      const std::string per_disc = folder.path("per-disc");
      REQUIRE(detp("run --calibration none --technique octree --standard-error --discs " + discs + " --ray-file " +
                   rays + " --per-disc " + per_disc)
                  .code == 0);
      found.push_back(content_of(per_disc));
    }
    CHECK(found[0] == found[1]);
    CHECK(found[0].size() > 10'000);
  }

  TEST_CASE("--light places the lights that it names, and the answer says so") {
    const Json one = detp(words("run @cornell --rays 2000 --light spot --format json")).json();
    CHECK(one.at("inputs").at("light") == Json::parse(R"([{"kind": "spot", "flux": 1.0}])"));
    CHECK(one.at("inputs").at("up") == "y");
    const Json two =
        detp(words("run @cornell --rays 2000 --light environment,directional --up z --format json")).json();
    REQUIRE(two.at("inputs").at("light").size() == 2);
    CHECK(two.at("inputs").at("light").at(0).at("kind") == "environment");
    CHECK(two.at("inputs").at("light").at(1).at("flux") == 0.5);
    CHECK(two.at("inputs").at("up") == "z");
    CHECK(one.at("hits") != two.at("hits"));
    const Finished text = detp(words("scene @cornell --rays 2000 --light area,spot"));
    CHECK(text.out.find("lights: area, spot (up: y)") != std::string::npos);
  }

  TEST_CASE("a file's emitting materials are its light; up is found for a mesh that stands along z") {
    const ScratchFolder folder;
    (void)folder.file("lamp.mtl", "newmtl lamp\nKe 5\nnewmtl floor\nKd 0.5\n");
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0.5\nv 1 0 0.5\nv 0 1 0.5\n";
    const std::string faces = "usemtl floor\nf 1 2 3\nf 1 3 4\n";
    const std::string lit = folder.file("lit.obj", "mtllib lamp.mtl\n" + square + faces + "usemtl lamp\nf 5 7 6\n");
    const Json own = detp(words("run " + lit + " --rays 1000 --format json")).json();
    CHECK(own.at("inputs").at("light").at(0).at("kind") == "surface");
    const std::string dark = folder.file("dark.obj", square + faces);
    const Json placed = detp(words("run " + dark + " --rays 1000 --disc-radius 0.1 --format json")).json();
    CHECK(placed.at("inputs").at("light").at(0).at("kind") == "area");
    CHECK(placed.at("inputs").at("up") == "z");
  }

  TEST_CASE("a mixed field: two techniques find the same hits, and its shares are in the answer") {
    Json hits;
    for (const std::string technique : {"box-tree", "octree"}) {
      const Json json =
          detp(words("run @cornell --field mixed:0.5:0.25:0.25 --rays 5000 --format json --technique " + technique))
              .json();
      CHECK(json.at("inputs").at("field") == "mixed");
      CHECK(json.at("inputs").at("shares").at("point") == 0.25);
      CHECK((hits.is_null() || hits == json.at("hits")));
      hits = json.at("hits");
      CHECK(hits > 1000);
    }
  }
}

}  // namespace detp::support
