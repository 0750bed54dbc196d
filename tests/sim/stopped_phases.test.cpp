#include <doctest/doctest.h>

#include <filesystem>
#include <vector>

#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/geometry/curve_sort.hpp"
#include "detp/sim/geometry/hilbert.hpp"
#include "detp/sim/index/disc_index.hpp"
#include "detp/sim/lists/plain/ray_list.hpp"
#include "detp/sim/lists/simd/disc_tree.hpp"
#include "detp/sim/lists/sphere_nodes.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/photons/placed_lights.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/resample.hpp"
#include "detp/sim/scene/vertices.hpp"
#include "detp/sim/search/index.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/scratch_file.hpp"
#include "support/work_log.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t block = StopCheck::most_work;

/// Some long work, and the minimum amount of work that it must report.
struct Phase {
  std::string name;
  std::function<void(const std::stop_token&)> run;
  std::uint64_t least_work;
};

/// Checks that the work between two checks is bounded, and that a stop request half way throws Stopped there.
void check_phase(const Phase& phase) {
  CAPTURE(phase.name);
  const double total = support::bounded_work_of([&] { phase.run({}); });
  CHECK(total + block > static_cast<double>(phase.least_work));
  const support::StopAfterWork stop(total / 2);
  CHECK_THROWS_AS(phase.run(stop.token()), Stopped);
  CHECK(stop.total() < total / 2 + 10.0 * block);
}

void use(const auto&) {}

const std::vector<Disc>& discs() {
  static const std::vector<Disc> all = uniform_discs(Body::cube, 2, 300'000, 0.002, 1);
  return all;
}

const Problem& problem() {
  static const std::vector<Ray> ray{Ray{}};
  static const Problem all = make_problem(ray, discs());
  return all;
}

const Scene& tree() {
  static const Scene scene = open_scene({"@tree", std::nullopt, 1});
  return scene;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the work between two checks is bounded while rays and samples are made, and a stop request ends it") {
    const Sphere sphere{};
    use(tree());  // opened before work is logged
    std::vector<Ray> room(300'000);
    check_phase(
        {"lines", [&](const auto& stop) { use(LineField(sphere, 1).lines(0, room.size(), stop)); }, room.size()});
    check_phase({"lines of a stream",
                 [&](const auto& stop) { LinesOfField(sphere, 1, room.size()).read(0, room, stop); }, room.size()});
    check_phase({"photon paths", [](const auto& stop) { use(photon_paths(tree(), 30'000, 1, stop).rays); }, 30'000});
    check_phase(
        {"counting photon paths", [](const auto& stop) { use(PhotonSource(tree(), 30'000, 1, stop).size()); }, 30'000});
    const PhotonSource source(tree(), 30'000, 1);
    std::vector<Ray> photons(30'000);
    check_phase({"reading photon paths", [&](const auto& stop) { source.read(0, photons, stop); }, photons.size()});
    check_phase({"uniform samples", [](const auto& stop) { use(uniform_discs(Body::cube, 1, 300'000, 0.1, 1, stop)); },
                 300'000});
    check_phase({"samples on triangles",
                 [](const auto& stop) {
                   use(open_scene({"@cornell", 300'000, 1}, stop));
                 },
                 300'000});
  }

  TEST_CASE("the work between two checks is bounded while rays and discs are checked, and a stop request ends it") {
    std::vector<Ray> rays = LineField(problem().enclosing(), 2).lines(0, 400'000);
    std::vector<Disc> some = discs();
    check_phase({"enclosing sphere", [&](const auto& stop) { use(enclosing_sphere(some, stop)); }, some.size()});
    const Phase problem_phase{"a problem", [&](const auto& stop) { use(make_problem(rays, some, false, 1, stop)); },
                              some.size() + rays.size()};
    check_phase(problem_phase);
    rays.back().direction *= 2.0;  // now both are copied
    some.back().normal *= 2.0;
    check_phase({"a problem with directions to normalise", problem_phase.run, 4 * some.size() + 3 * rays.size()});
  }

  TEST_CASE("the work between two checks is bounded while a mesh is measured, and a stop request ends it") {
    const Mesh& mesh = tree().mesh;
    const std::uint64_t triangles = mesh.triangles.size();
    check_phase({"edges", [&](const auto& stop) { use(mean_edge_length(mesh, stop)); }, 3 * triangles});
    check_phase({"light",
                 [&](const auto& stop) { use(placed_lights(std::array{LightKind::area}, mesh, tree().box, {}, stop)); },
                 triangles});
    check_phase({"up", [&](const auto& stop) { use(up_of(mesh, tree().box, stop)); }, triangles});
    Notices notices;
    check_phase({"vertices",
                 [&](const auto& stop) {
                   Mesh own = mesh;
                   use(samples_at_vertices(own, default_crease, notices, stop));
                 },
                 triangles});
  }

  TEST_CASE("the work between two checks is bounded while discs are sorted, and a stop request ends it") {
    const std::uint64_t count = discs().size();
    for (const SampleOrder order : {SampleOrder::lebesgue, SampleOrder::hilbert})
      check_phase({"a curve", [=](const auto& stop) { use(along_curve(discs(), order, stop)); }, 7 * count});
    check_phase({"the coarse curve",
                 [](const auto& stop) { use(stream::sort_along_curve(discs(), problem().centres(), 1, stop)); },
                 4 * count});
  }

  TEST_CASE("the work between two checks is bounded while any index is built, and a stop request ends it" *
            doctest::test_suite("long")) {
    const std::uint64_t count = discs().size();
    const stream::Frame frame(problem());
    check_phase({"tree of boxes",
                 [&](const auto& stop) {
                   use(stream::make_disc_tree(problem(), frame, {4, 16}, {.stop = stop}));
                 },
                 8 * count});
    const auto order = along_curve(discs());
    check_phase({"tree of spheres",
                 [&](const auto& stop) {
                   use(make_sphere_tree(discs(), order, SphereTreeParameters{8, 4}, stop));
                 },
                 count});
    for (const Candidate& candidate :
         {Candidate{Technique::octree, OctreeParameters{4}},
          Candidate{Technique::octree, OctreeParameters{4, Traversal::neighbour_links}},
          Candidate{Technique::grid, GridParameters{60}}, Candidate{Technique::bsp, BspParameters{}}})
      check_phase({std::string(name(candidate.technique)) + " " + describe(candidate),
                   [&](const auto& stop) { use(prepare(problem(), candidate, {.stop = stop})); }, count});
  }

  TEST_CASE("a stop request ends Embree's build of a tree" * doctest::skip(!has_embree)) {
    std::stop_source source;
    source.request_stop();
    const Candidate bvh{Technique::bvh, BvhParameters{BuildQuality::medium}};
    CHECK_THROWS_WITH_AS(use(prepare(problem(), bvh, {.stop = source.get_token()})), "stopped while building the BVH",
                         Stopped);
    CHECK(prepare(problem(), bvh, {}) != nullptr);
  }

  TEST_CASE("the work between two checks is bounded while files are written; a stop request leaves none behind") {
    const support::ScratchFolder folder;
    const std::vector<Ray> rays = LineField(Sphere{}, 1).lines(0, 60'000);
    const std::vector<Disc> some(discs().begin(), discs().begin() + 60'000);
    const std::string path = folder.path("file");
    const auto written = [&](const auto& write) {
      return [&path, write](const std::stop_token& stop) {
        std::filesystem::remove(path);
        try {
          write(stop);
        } catch (const Stopped&) {
          CHECK_FALSE(std::filesystem::exists(path));
          throw;
        }
      };
    };
    check_phase({"rays", written([&](const auto& stop) { write_rays(path, rays, stop); }), rays.size()});
    check_phase({"discs", written([&](const auto& stop) { write_discs(path, some, stop); }), some.size()});
    check_phase({"a mesh", written([&](const auto& stop) { write_ply(path, tree().mesh, stop); }),
                 tree().mesh.triangles.size()});
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("stopped tracing says how many of the rays had been traced") {
    use(tree());  // opened before work is logged
    const support::StopAfterWork stop(100.0 * block);
    try {
      use(photon_paths(tree(), 200'000, 1, stop.token()).rays);
      FAIL("it went on");
    } catch (const Stopped& stopped) {
      CHECK(stopped.progress().of == 200'000);
      CHECK(stopped.progress().done < 200'000);
      CHECK(stopped.progress().unit == "rays");
      CHECK(std::string(stopped.what()).starts_with("stopped while tracing photons after "));
    }
  }
}

}  // namespace detp::sim
