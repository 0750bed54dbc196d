#include "detp/sim/open/open_scene.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "detp/sim/files/file_error.hpp"
#include "detp/sim/scene/coincident.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

bool same(const std::vector<Sample>& first, const std::vector<Sample>& second) {
  return std::ranges::equal(
      first, second, [](const Sample& a, const Sample& b) { return a.position == b.position && a.normal == b.normal; });
}

/// Whether the samples are among `all`, in the same order.
bool in_order_among(const std::vector<Sample>& some, const std::vector<Sample>& all) {
  auto next = all.begin();
  for (const Sample& sample : some) {
    next = std::find_if(next, all.end(), [&](const Sample& other) { return other.position == sample.position; });
    if (next == all.end()) return false;
    ++next;
  }
  return true;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("every built-in scene opens, with samples in its box, and a light where its rays are photons") {
    for (const std::string name : {"@uniform", "@tree", "@tree-coarse", "@courtyard", "@cornell", "@caustic",
                                   "@interior", "@furnace", "@sunlit"}) {
      CAPTURE(name);
      const Scene scene = open_scene({.name = name, .samples = {}});
      CHECK(scene.name == name);
      CHECK(scene.samples.size() > 1000);
      CHECK(!scene.lights.empty() == (scene.field == Field::photons));
      Box box = scene.box;
      for (const Sample& sample : scene.samples) box.include(sample.position);
      CHECK(box.low == scene.box.low);
      CHECK(box.high == scene.box.high);
    }
  }

  TEST_CASE("no faces of a built-in scene are in the same place" * doctest::test_suite("long")) {
    for (const char* name : {"@tree-coarse", "@courtyard", "@cornell", "@caustic", "@interior", "@room:8", "@machine:9",
                             "@details:7", "@plant:7", "@shells:7", "@terrain:7"}) {
      CAPTURE(name);
      Scene scene = open_scene({.name = name, .samples = {}});
      CHECK(scene.notices.empty());
      const std::size_t triangles = scene.mesh.triangles.size();
      join_coincident(scene.mesh, scene.notices);
      CHECK(scene.mesh.coincident == 0);
      CHECK(scene.mesh.triangles.size() == triangles);
    }
  }

  TEST_CASE("@uniform is 100 000 samples in the cube [-1, 1]³ and isotropic lines, without triangles or light") {
    const Scene scene = open_scene({.name = "@uniform", .samples = {}});
    CHECK(scene.samples.size() == 100'000);
    CHECK(scene.mesh.triangles.empty());
    CHECK(scene.field == Field::isotropic);
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(scene.box.low[axis] >= -1);
      CHECK(scene.box.low[axis] < -0.999);
      CHECK(scene.box.high[axis] <= 1);
      CHECK(scene.box.high[axis] > 0.999);
    }
    CHECK(open_scene({.name = "@uniform", .samples = 17}).samples.size() == 17);
  }

  TEST_CASE("fewer samples than vertices are a subset of them in their order, another subset for another seed") {
    const Scene all = open_scene({.name = "@cornell", .samples = {}});
    const Scene some = open_scene({.name = "@cornell", .samples = 1000, .seed = 1});
    CHECK(some.samples.size() == 1000);
    CHECK(in_order_among(some.samples, all.samples));
    CHECK(same(some.samples, open_scene({.name = "@cornell", .samples = 1000, .seed = 1}).samples));
    CHECK_FALSE(same(some.samples, open_scene({.name = "@cornell", .samples = 1000, .seed = 2}).samples));
    CHECK(open_scene({.name = "@cornell", .samples = 1}).samples.size() == 1);
  }

  TEST_CASE("more samples than vertices are all vertices and points on the surface, with the surface's normals") {
    const support::ScratchFolder folder;
    const std::string path = folder.file("plane.obj", "v 0 3 0\nv 2 3 0\nv 0 3 2\nf 1 3 2\n");
    const Scene scene = open_scene({.name = path, .samples = 500});
    REQUIRE(scene.samples.size() == 500);
    for (const Sample& sample : scene.samples) {
      CHECK(sample.position.y == 3);
      CHECK((sample.position.x >= 0 && sample.position.z >= 0 && sample.position.x + sample.position.z <= 2));
      CHECK(sample.normal == glm::dvec3{0, 1, 0});
    }
    CHECK(same(scene.samples, open_scene({.name = path, .samples = 500}).samples));
    CHECK(scene.box.high == glm::dvec3{2, 3, 2});
  }

  TEST_CASE("samples are added at any scale") {
    const support::ScratchFolder folder;
    for (const std::string power : {"-170", "-13", "12", "170"}) {
      const std::string e = "e" + power;
      const std::string path = folder.file("scale.obj", "v 0 0 0\nv 1" + e + " 0 0\nv 0 0 1" + e + "\nf 1 3 2\n");
      const Scene scene = open_scene({.name = path, .samples = 20});
      REQUIRE(scene.samples.size() == 20);
      CHECK(scene.samples.back().normal == glm::dvec3{0, 1, 0});
    }
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("added samples fall on triangles in proportion to their areas") {
    const support::ScratchFolder folder;
    // Areas 1/2 and 3/2.
    const std::string path =
        folder.file("two.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 5 0 0\nv 8 0 0\nv 5 0 1\nf 1 3 2\nf 4 6 5\n");
    constexpr std::size_t added = 40'000;
    const Scene scene = open_scene({.name = path, .samples = added + 6});
    const auto large = std::count_if(scene.samples.begin() + 6, scene.samples.end(),
                                     [](const Sample& sample) { return sample.position.x > 2; });
    const double share = static_cast<double>(large) / added;
    const double error = std::sqrt(0.75 * 0.25 / added);
    CHECK(std::abs(share - 0.75) < 5 * error);
    CHECK_MESSAGE(std::abs(share - 0.75 * 1.05) > 5 * error, "negative control: 5 % off must not pass");
  }

  TEST_CASE("thinning keeps as many of the first half of the vertices as of the second") {
    const Scene all = open_scene({.name = "@cornell", .samples = {}});
    const std::size_t vertices = all.samples.size();
    double first_half = 0;
    constexpr int seeds = 50;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Scene some = open_scene({.name = "@cornell", .samples = vertices / 2, .seed = seed});
      for (std::size_t i = 0, j = 0; i < vertices / 2 && j < some.samples.size(); ++i)
        if (some.samples[j].position == all.samples[i].position) {
          ++first_half;
          ++j;
        }
    }
    // Hypergeometric distribution: the mean is half of n/2, the variance n/16.
    const double n = static_cast<double>(vertices);
    CHECK(std::abs(first_half / seeds - n / 4) < 5 * std::sqrt(n / 16 / seeds));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an unknown built-in name is refused; the message lists the known ones") {
    CHECK_THROWS_WITH_AS(
        (void)open_scene({.name = "@forest", .samples = {}}),
        "there is no built-in scene @forest; known scenes are @uniform, @tree, @tree-coarse, @courtyard, "
        "@cornell, @caustic, @interior, @furnace, @sunlit, "
        "@room:SEED, @plant:SEED, @machine:SEED, @terrain:SEED, @shells:SEED, @details:SEED",
        std::invalid_argument);
  }

  TEST_CASE("zero samples are refused") {
    for (const char* name : {"@uniform", "@cornell", "missing.obj"})
      CHECK_THROWS_WITH_AS((void)open_scene({.name = name, .samples = 0}), "a scene needs at least 1 sample (got 0)",
                           std::invalid_argument);
  }

  TEST_CASE("a mesh that yields no sample is refused by name") {
    const support::ScratchFolder folder;
    const std::string path = folder.file("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    const std::string message = support::file_error_of([&] { (void)open_scene({.name = path, .samples = {}}); });
    CHECK(message == path + ": no vertex has a normal; irradiance needs triangles with an area");
  }

  TEST_CASE("a mesh without area cannot have more samples than vertices") {
    const support::ScratchFolder folder;
    const std::string path = folder.file("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nvn 0 1 0\nf 1//1 2//1 3//1\n");
    CHECK(open_scene({.name = path, .samples = {}}).samples.size() == 3);
    const std::string message = support::file_error_of([&] { (void)open_scene({.name = path, .samples = 4}); });
    CHECK(message.find("so that only its 3 vertices can be samples (4 asked for)") != std::string::npos);
  }

  TEST_CASE("a missing file is refused by name") {
    CHECK(support::file_error_of([] {
            (void)open_scene({.name = "missing.obj", .samples = {}});
          }).starts_with("missing.obj: "));
  }
}
