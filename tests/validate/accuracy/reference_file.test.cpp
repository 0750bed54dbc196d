#include "detp/validate/accuracy/reference.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stop_token>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using doctest::Contains;
using validate::ReferenceOptions;

namespace {

struct ReferencePath {
  support::ScratchFolder folder;
  std::string path = folder.path("reference.json");

  void replace(const std::string& what, const std::string& by) const {
    std::string all = support::content_of(path);
    const std::size_t at = all.find(what);
    REQUIRE(at != std::string::npos);
    std::ofstream(path) << all.replace(at, what.size(), by);
  }
};

ReferenceOptions quick() { return {.samples = 20, .error = 0.2}; }

}  // namespace

TEST_SUITE("references in files") {
  TEST_CASE("a reference is made once: the second call reads the same numbers from the file") {
    const ReferencePath file;
    const sim::Scene scene = sim::open_scene({.name = "@cornell", .samples = {}});
    const auto made = validate::kept_reference(file.path, scene, quick());
    REQUIRE(std::filesystem::exists(file.path));
    std::stop_source stop;
    stop.request_stop();  // making it again would throw
    ReferenceOptions stopped = quick();
    stopped.stop = stop.get_token();
    const auto read = validate::kept_reference(file.path, scene, stopped);
    CHECK(read.irradiance == made.irradiance);
    CHECK(read.variance == made.variance);
    CHECK(read.kind == validate::ReferenceKind::backward);
    CHECK(read.paths == made.paths);
    CHECK(read.error() == made.error());
    CHECK(read.judged.weights == made.judged.weights);
    CHECK(read.judged.places == made.judged.places);
    for (std::size_t i = 0; i < made.judged.samples.size(); ++i) {
      CHECK(read.judged.samples[i].position == made.judged.samples[i].position);
      CHECK(read.judged.samples[i].normal == made.judged.samples[i].normal);
    }
  }

  TEST_CASE("a reference of a scene with mirrors, whose samples do not count, is read again") {
    const ReferencePath file;
    const sim::Scene scene = sim::open_scene({.name = "@caustic", .samples = {}});
    ReferenceOptions options = quick();
    options.error = 0.5;
    const auto made = validate::kept_reference(file.path, scene, options);
    CHECK(made.judged.population < scene.samples.size());
    // As of a larger reference, whose last sample is the scene's last.
    file.replace(fmt::format("\"population\": {}", made.judged.population),
                 fmt::format("\"population\": {}", made.judged.places.back()));
    CHECK_THROWS_WITH_AS(static_cast<void>(validate::kept_reference(file.path, scene, options)), Contains("altered"),
                         sim::FileError);
  }

  TEST_CASE("a reference that a stop request cut short leaves no file") {
    const ReferencePath file;
    std::stop_source stop;
    stop.request_stop();
    ReferenceOptions options = quick();
    options.stop = stop.get_token();
    CHECK_THROWS_AS(static_cast<void>(validate::kept_reference(
                        file.path, sim::open_scene({.name = "@cornell", .samples = {}}), options)),
                    sim::Stopped);
    CHECK_FALSE(std::filesystem::exists(file.path));
  }

  TEST_CASE("a file of other lights, materials, samples or sides is refused, and the error says what differs") {
    const ReferencePath file;
    sim::Scene scene = sim::open_scene({.name = "@furnace", .samples = {}});
    static_cast<void>(validate::kept_reference(file.path, scene, quick()));
    const auto refused = [&](const sim::Scene& other, const ReferenceOptions& options, const char* what) {
      CHECK_THROWS_WITH_AS(static_cast<void>(validate::kept_reference(file.path, other, options)), Contains(what),
                           sim::FileError);
    };
    ReferenceOptions more = quick();
    more.samples = 30;
    refused(scene, more, "another samples: 20, here it is 30");
    ReferenceOptions front = quick();
    front.front_facing = true;
    refused(scene, front, "front_facing");
    sim::Scene dimmed = scene;
    dimmed.lights.front().flux *= 0.5;
    refused(dimmed, quick(), "another scene");
    sim::Scene painted = scene;
    painted.mesh.materials.all.front().diffuse = 0.4;
    refused(painted, quick(), "another scene");
    sim::Scene moved = scene;
    moved.mesh.positions.front().x += 1e-9;
    refused(moved, quick(), "another scene");
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a file that is no reference, or a damaged one, gets a clear error") {
    const sim::Scene scene = sim::open_scene({.name = "@furnace", .samples = {}});
    const std::vector<std::array<std::string, 3>> damages{
        {"detp.reference", "detp.calibrate", "is not a reference of this version"},
        {"\"known\"", "\"guessed\"", "its kind is"},
        {"\"paths\": 0", "\"paths\": \"many\"", "is not a reference"},
        {"\"samples\": [\n", "\"samples\": [[1, 2, 3],\n", "a sample needs 10 numbers"},
        {"6.283185307179586,0.0,", "6.283185307179586,-1.0,", "a variance is below 0"},
        {"6.283185307179586,0.0,", "6.283185307179586,1e999,", "is not a reference"},
        {"]\n  ]\n}", "9]\n  ]\n}", "a sample is not one of the scene's"},
        {"  ]\n}", "", "is not a reference"}};
    for (const std::array<std::string, 3>& damage : damages) {
      const std::string& to = damage[1];
      const ReferencePath file;
      static_cast<void>(validate::kept_reference(file.path, scene, quick()));
      file.replace(damage[0], to);
      CAPTURE(to);
      CHECK_THROWS_WITH_AS(static_cast<void>(validate::kept_reference(file.path, scene, quick())),
                           Contains(damage[2].c_str()), sim::FileError);
    }
  }
}
