#include <doctest/doctest.h>

#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "support/command.hpp"
#include "support/sealed.hpp"

namespace detp::support {
namespace {

const std::string disc_header = "x,y,z,nx,ny,nz,radius\n";
const std::string ray_header = "ox,oy,oz,dx,dy,dz,length,power\n";
const std::string ply_header =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";

Refusal as_scene(const std::string& path, const std::string& named) {
  return {Arguments{"scene", path} + words("--rays 10"), named};
}

/// Makes command lines that must be refused: with a bad disc file, or with good discs and a bad ray file.
struct Tables {
  ScratchFolder folder;
  std::string discs = folder.file("good.csv", disc_header + "0,0,0,0,0,1,1\n1,0,0,0,0,1,1\n");
  int last = 0;

  std::string file(const std::string& content) { return folder.file(std::to_string(++last) + ".csv", content); }
  static Refusal as_discs(const std::string& path, const std::string& named) {
    return {Arguments{"run", "--discs", path} + words("--rays 10"), named};
  }
  [[nodiscard]] Refusal as_rays(const std::string& path, const std::string& named) const {
    return {Arguments{"run", "--discs", discs, "--ray-file", path}, named};
  }
  Refusal disc(const std::string& row, const std::string& named) {
    const std::string path = file(disc_header + "0,0,0,0,0,1,1\n" + row + "\n");
    return as_discs(path, path + ":3: " + named);
  }
  Refusal ray(const std::string& row, const std::string& named) {
    const std::string path = file(ray_header + "0,0,0,0,0,1,1,1\n" + row + "\n");
    return as_rays(path, path + ":3: " + named);
  }
};

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("unreadable meshes are refused, naming the file and, if known, the line") {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder.path("folder.obj"));
    const std::string index = folder.file("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    const std::string number = folder.file("number.obj", "v 0 0 0\nv 1 zero 0\nv 0 1 0\nf 1 2 3\n");
    const std::string magic = folder.file("magic.ply", "plum\n");
    check_refused({as_scene(folder.path("missing.obj"), "missing.obj: cannot be opened"),
                   as_scene(folder.path("missing.ply"), "missing.ply: cannot be opened"),
                   as_scene(folder.path("folder.obj"), "folder.obj: cannot be read"),
                   as_scene(folder.file("empty.obj", ""), "empty.obj: "),
                   as_scene(folder.file("empty.ply", ""), "empty.ply: "),
                   as_scene(folder.file("vertices.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "has no faces"),
                   as_scene(index, index + ":4: "), as_scene(number, number + ":2: "), as_scene(magic, magic + ":1: "),
                   as_scene(folder.file("rows.ply", ply_header + "0 0 0\n1 0 0\n"), "rows.ply: ends early"),
                   as_scene(folder.file("face.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), "face.ply: "),
                   as_scene(folder.file("nan.ply", ply_header + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "not finite"),
                   as_scene(folder.file("wrong.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"), "face 1"),
                   as_scene(folder.file("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"), "point.obj: ")});
  }

  TEST_CASE("files of discs and rays that cannot be read are refused with the file") {
    Tables tables;
    const std::string folder = tables.folder.path("");
    const std::string missing = tables.folder.path("missing.csv");
    const std::string empty = tables.file("");
    const std::string magic = tables.folder.file("magic.ply", "plum\n");
    const std::string cut = tables.folder.file("cut.ply", ply_header + "0 0 0\n1 0 0\n");
    for (const auto& [path, named] :
         std::vector<std::pair<std::string, std::string>>{{missing, "missing.csv: cannot be opened"},
                                                          {folder, "Is a directory"},
                                                          {empty, empty + ": is empty"},
                                                          {magic, magic + ":1: "},
                                                          {cut, "cut.ply: "}})
      check_refused({Tables::as_discs(path, named), tables.as_rays(path, named)});
  }

  TEST_CASE("a wrong header is refused with its line and the known columns") {
    Tables tables;
    const auto discs = [&](const std::string& content, const std::string& named) {
      return Tables::as_discs(tables.file(content), ".csv" + named);
    };
    const auto rays = [&](const std::string& content, const std::string& named) {
      return tables.as_rays(tables.file(content), ".csv" + named);
    };
    check_refused({discs("a,b,c\n1,2,3\n", ":1: the header has no column x; known are x,y,z,nx,ny,nz,radius"),
                   discs("x,y,z,nx,ny\n1,2,3,4,5\n", ":1: the header has no column nz"),
                   discs("x,y,z,nx,ny,nz,x\n1,2,3,4,5,6,7\n", ":1: column x appears twice"),
                   discs("x,y,z,nx,ny,nz\n0,0,0,0,0,1\n", ":1: the header has no column radius"),
                   discs("1,2,3,4,5,6,7\n", ":1: the first line has numbers"), discs(disc_header, ": has no disc"),
                   rays(disc_header + "0,0,0,0,0,1,1\n", ":1: the header has no column ox; known are ox,oy,oz"),
                   rays("ox,oy,oz,dx,dy\n0,0,0,0,0\n", ":1: the header has no column dz"),
                   rays(ray_header, ": has no ray")});
  }

  TEST_CASE("a malformed row is refused with its line") {
    Tables tables;
    check_refused({tables.disc("0,0,0,0,0,0,1", "the normal is zero"), tables.disc("0,0,0,0,0,1,0", "radius must be"),
                   tables.disc("0,0,0,0,0,1,-2", "radius must be"), tables.disc("0,0,0,0,0,1,nan", "radius must be"),
                   tables.disc("0,0,0,0,0,1,inf", "radius must be"), tables.disc("nan,0,0,0,0,1,1", "x must be finite"),
                   tables.disc("0,0,inf,0,0,1,1", "z must be finite"), tables.disc("0,0,0,0,nan,1,1", "ny must be"),
                   tables.disc("0,0,0,0,0,1", "6 fields"), tables.disc("0,0,0,0,0,1,1,1", "8 fields"),
                   tables.disc("0,0,0,0,0,one,1", "nz is \"one\""), tables.disc("0,0,,0,0,1,1", "z is empty")});
    check_refused({tables.ray("0,0,0,0,0,0,1,1", "the direction is zero"),
                   tables.ray("0,0,0,0,0,1,0,1", "length must be"), tables.ray("0,0,0,0,0,1,-1,1", "length must be"),
                   tables.ray("0,0,0,0,0,1,nan,1", "length must be"), tables.ray("0,0,0,0,0,1,1,-1", "power must be"),
                   tables.ray("0,0,0,0,0,1,1,nan", "power must be"), tables.ray("0,0,0,0,0,1,1,inf", "power must be"),
                   tables.ray("0,nan,0,0,0,1,1,1", "oy must be finite"),
                   tables.ray("0,0,0,inf,0,1,1,1", "dx must be finite"), tables.ray("0,0,0,0,0,1", "6 fields")});
  }

  TEST_CASE("powers whose irradiance would not be finite are refused with the ray's number") {
    Tables tables;
    const std::string row = "0,0,1,0,0,1,1,";
    std::vector<Refusal> refusals;
    for (const std::string power : {"1e300", "1e308"})
      for (const std::string format : {"text", "csv", "json"}) {
        const std::string rays = tables.file(ray_header + row + "1\n" + row + power + "\n" + row + power + "\n");
        refusals.push_back(
            {Arguments{"run", "--discs", tables.discs, "--ray-file", rays, "--format", format}, "ray 1"});
        refusals.push_back({Arguments{"choose", "--discs", tables.discs, "--ray-file", rays, "--analyze"}, "ray 1"});
      }
    check_refused(refusals);
  }

  TEST_CASE("options that have no effect with a file are refused") {
    const Tables tables;
    const std::string rays = tables.folder.file("rays.csv", ray_header + "0,0,0,0,0,1,1,1\n");
    const Arguments run{"run", "--discs", tables.discs};
    check_refused({{run + words("--samples 4"), "number of samples"},
                   {run + words("--disc-radius 4%"), "percentage"},
                   {run + words("--field photons"), "scene"},
                   {run + Arguments{"--rays", "5", "--ray-file", rays}, "number of rays"},
                   {Arguments{"run", "--ray-file", rays}, "disc file"},
                   {words("validate --front-facing"), "--front-facing"},
                   {words("validate --field photons"), "--field photons"}});
  }

  TEST_CASE("results that cannot be written are reported, and nothing is left behind") {
    const ScratchFolder folder;
    const Arguments run = words("run @uniform --samples 100 --rays 100");
    const Arguments scene = words("scene @cornell --rays 100");
    const std::string missing = folder.path("missing/result");
    std::vector<Refusal> refusals;
    for (const std::string option : {"--output", "--per-disc", "--pairs"})
      for (const std::string& path : {missing, std::string("/dev/full"), folder.path("")})
        refusals.push_back({run + Arguments{option, path}, path + ": cannot be written"});
    for (const std::string option : {"--write-mesh", "--write-discs", "--write-rays"})
      for (const std::string& path : {missing, std::string("/dev/full"), folder.path("")})
        refusals.push_back({scene + Arguments{option, path}, path + ": cannot be written"});
    check_refused(refusals);
    CHECK(folder.entries() == 0);
  }

  TEST_CASE("two outputs to one place are refused before any work, however they are spelled") {
    const ScratchFolder folder;
    std::filesystem::create_symlink("one", folder.path("link"));
    const std::string one = folder.path("one");
    const std::string again = folder.path("./one");
    const std::string thorough = "validate --effort thorough --checkpoint ";
    std::vector<Refusal> refusals;
    for (const std::string& other : {one, again, folder.path("link")}) {
      refusals.push_back(
          {"run @uniform --output " + one + " --per-disc " + other, "--output and --per-disc name the same"});
      refusals.push_back(
          {"run @uniform --per-disc " + one + " --pairs " + other, "--per-disc and --pairs name the same"});
      refusals.push_back({"scene @tree --write-rays " + one + " --write-discs " + other, "name the same"});
      refusals.push_back({thorough + one + " --output " + other, "--output and --checkpoint name the same"});
      refusals.push_back({thorough + one + " --sweep-rows " + other, "--checkpoint and --sweep-rows name the same"});
    }
    check_refused(refusals);
    CHECK(folder.entries() == 1);
  }

  TEST_CASE("a checkpoint that cannot be continued, or not be written, is refused before any work") {
    const ScratchFolder folder;
    const auto resumed = [&](const std::string& content, const std::string& named) {
      const std::string path = folder.file(std::to_string(folder.entries()), content);
      return Refusal("validate --effort thorough --resume --checkpoint " + path, named);
    };
    const Json with_seed{{"schema", {{"name", "detp.checkpoint"}, {"version", validate::checkpoint_version}}},
                         {"work", "validate --effort thorough"},
                         {"key", {{"seed", 7}}},
                         {"state", Json::object()}};
    check_refused({resumed("", "is not a checkpoint"),
                   resumed("{\x1b[2J", "is not a checkpoint"),
                   resumed("{}", "is not a checkpoint"),
                   resumed(std::string(5000, '['), "is not a checkpoint"),
                   resumed(sealed_checkpoint(with_seed), "was made with seed 7"),
                   resumed(with_seed.dump(), "is not a checkpoint"),
                   resumed(R"({"schema":{"name":"detp.checkpoint","version":9}})", "not a checkpoint of this version"),
                   {"validate --effort thorough --checkpoint " + folder.path("missing/c"), "cannot be written"},
                   {"validate --effort thorough --resume --checkpoint " + folder.path(""), "Is a directory"}});
  }

  TEST_CASE("messages quote at most 60 characters of the input, and no control character") {
    const ScratchFolder folder;
    const std::string digits(100'000, '7');
    const std::string sixty = std::string(60, '7') + "...";
    const std::string rays = folder.file("rays.csv", ray_header + "0,0,0,0,0,1,1," + digits + "x\n");
    const std::string discs = folder.file("discs.csv", disc_header + "0,0,0,0,0,1,1\n");
    const std::string ply =
        folder.file("p.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty " + digits + " x\n");
    const std::vector<Refusal> refusals{{Arguments{"run", "--discs", discs, "--ray-file", rays}, sixty},
                                        {Arguments{"scene", ply}, sixty},
                                        {Arguments{"run", "@" + digits}, sixty.substr(1)},
                                        {Arguments{"run", "@uniform", "--rays", digits + "x"}, sixty},
                                        {Arguments{"run", "@uniform", "--rays=" + digits + "x"}, sixty},
                                        {Arguments{"run", "@uniform", "--disc-radius", digits + "x"}, sixty},
                                        {Arguments{"run", "@uniform", "--seed", digits}, sixty},
                                        {Arguments{"run", "@uniform", "--format", digits}, sixty},
                                        {Arguments{"run", "@uniform", "--technique", digits}, sixty},
                                        {Arguments{"run", "@uniform", "--" + digits}, sixty.substr(3)},
                                        {Arguments{"choose", "@uniform", "--costs", "t=" + digits + "x"}, "7777777777"},
                                        {Arguments{digits}, sixty},
                                        {Arguments{"run", "@\x1b[2J\xff"}, "\\x1b[2J\\xff"},
                                        {Arguments{"run", "@uniform", "--format", "\x1b[2J"}, "\\x1b[2J"},
                                        {Arguments{"run", "@uniform", "--technique", "\xc2\x9b\r"}, "\\xc2\\x9b\\x0d"}};
    check_refused(refusals);
    for (const Refusal& refusal : refusals) {
      const std::string message = detp(refusal.arguments).err;
      CAPTURE(message);
      CHECK(message.find(digits.substr(0, 61)) == std::string::npos);
      CHECK(message.size() < 520);
      CHECK(std::none_of(message.begin(), message.end() - 1, [](unsigned char c) { return c < 0x20 || c > 0x7e; }));
    }
  }
}

}  // namespace detp::support
