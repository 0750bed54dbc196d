#include "detp/validate/accuracy/reference.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <stop_token>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/validate/accuracy/replicates.hpp"
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

  TEST_CASE("a reference of a scene with mirrors, whose samples do not count, is read again" *
            doctest::test_suite("long")) {
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

namespace detp::validate {
namespace {

sim::Scene opened(const char* name, std::vector<sim::LightKind> lights = {}) {
  return sim::open_scene({.name = name, .samples = {}, .lights = std::move(lights)});
}

}  // namespace

TEST_SUITE("references") {
  TEST_CASE("a known irradiance is taken, but not with other lights") {
    const sim::Scene furnace = opened("@furnace");
    const Reference reference = make_reference(furnace, {.samples = 50});
    CHECK(reference.kind == ReferenceKind::known);
    CHECK(reference.judged.samples.size() == 50);
    CHECK(reference.irradiance == std::vector<double>(50, 2 * std::numbers::pi));
    CHECK(reference.error() == 0);
    CHECK(make_reference(opened("@furnace", {sim::LightKind::point}), {.samples = 20, .error = 0.3}).kind ==
          ReferenceKind::backward);
  }

  TEST_CASE("backward paths reach the error that is asked for; the bytes do not depend on threads") {
    const sim::Scene cornell = opened("@cornell");
    const Reference one = make_reference(cornell, {.samples = 60, .error = 0.05});
    CHECK(one.kind == ReferenceKind::backward);
    CHECK(one.error() <= 0.05);
    CHECK_FALSE(one.stopped);
    ReferenceOptions options{.samples = 60, .error = 0.05};
    const Reference again = make_reference(cornell, options);
    CHECK(again.irradiance == one.irradiance);
    options.threads = 1;
    CHECK(make_reference(cornell, options).irradiance == one.irradiance);
  }

  TEST_CASE("photons on small patches agree with backward paths: the difference is within the errors" *
            doctest::test_suite("long")) {
    const sim::Scene cornell = opened("@cornell");
    const Reference backward = make_reference(cornell, {.samples = 200, .error = 0.02});
    sim::Scene mutable_scene = cornell;
    ReplicateMaker maker(mutable_scene, false, 0);
    std::vector<std::vector<double>> runs;
    const AccuracySetting patches{.estimator = sim::Estimator::area_corrected, .radius = 0.02};
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
      runs.push_back(maker.estimate(maker.trace(200'000, seed, 0), backward.judged.samples, patches).irradiance);
    const ErrorSplit split = split_error(runs, backward.values());
    // Half a cell of bias remains where shadows have edges.
    CHECK(root_of(split.bias_squared, runs.size()).low < 0.04);
    // Negative control: a reference that is 10 % too bright is found out.
    std::vector<double> bright = backward.irradiance;
    for (double& one : bright) one *= 1.1;
    CHECK(
        root_of(split_error(runs, {bright, backward.variance, backward.judged.weights}).bias_squared, runs.size()).low >
        0.05);
  }
}

TEST_SUITE("long") {
  TEST_CASE("light that backward paths miss comes from photons: together they are the light of all photons") {
    sim::Scene caustic = opened("@caustic");
    const Reference reference = make_reference(caustic, {.samples = 200, .error = 0.1, .seconds = 20});
    CHECK(reference.kind == ReferenceKind::both);
    CHECK(reference.photons > 1'000'000);
    CHECK(reference.missed_mean > 0.01);
    ReplicateMaker maker(caustic, false, 0);
    std::vector<std::vector<double>> runs;
    const AccuracySetting patches{.estimator = sim::Estimator::triangle_hits};
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
      runs.push_back(maker.estimate(maker.trace(200'000, seed, 0), reference.judged.samples, patches).irradiance);
    const ErrorSplit split = split_error(runs, reference.values());
    CHECK(std::abs(split.mean_bias.mean) < 4 * split.mean_bias.standard_error + 0.02);
    CHECK(std::abs(split.mean_bias.mean) < 0.5 * reference.missed_mean);  // without the photons it would be all of it
  }
}

TEST_SUITE("the judge's light") {
  TEST_CASE("missed light that no photon brings to the samples is bounded, not 0") {
    // So few photons bring nothing to three samples.
    sim::Scene caustic = opened("@caustic");
    ReferenceMaker maker(caustic, judged_samples(caustic, 3), {});
    maker.add_paths(16);
    maker.add_photons(100, 2);
    const Estimate missed = maker.reference().missed_squared;
    CHECK(missed.mean == 0);
    CHECK(missed.standard_error > 0.01);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("scenes without triangles and options out of range are refused") {
    CHECK_THROWS_WITH_AS((void)make_reference(opened("@uniform")), doctest::Contains("triangles"),
                         std::invalid_argument);
    const sim::Scene cornell = opened("@cornell");
    CHECK_THROWS_AS((void)make_reference(cornell, {.samples = 0}), std::invalid_argument);
    CHECK_THROWS_AS((void)make_reference(cornell, {.error = 0}), std::invalid_argument);
    CHECK_THROWS_AS((void)make_reference(cornell, {.seconds = -1}), std::invalid_argument);
  }

  TEST_CASE("a stop request before the first values is an error of its own") {
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS((void)make_reference(opened("@cornell"), {.stop = source.get_token()}), sim::Stopped);
  }
}

}  // namespace detp::validate
