#include "detp/validate/bench/workload.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

constexpr std::array all_awkward{AwkwardScene::clusters, AwkwardScene::tiny_object, AwkwardScene::thin_sheet,
                                 AwkwardScene::strays, AwkwardScene::mixed_radii};

bool is_same(const sim::Disc& a, const sim::Disc& b) {
  return a.centre == b.centre && a.normal == b.normal && a.radius == b.radius;
}

bool is_in_cube(const glm::dvec3& point) {
  return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) <= 0.5;
}

/// The number of discs for which the predicate holds.
std::size_t discs_where(const std::vector<sim::Disc>& discs, const auto& predicate) {
  return static_cast<std::size_t>(std::count_if(discs.begin(), discs.end(), predicate));
}

const std::vector<std::string> mesh_files{"stanford_bunny.obj", "sponza.ply", "bedroom.ply", "mountain.obj",
                                          "grove_fine.ply"};

/// All workloads, with meshes whose files are empty.
std::vector<BenchWorkload> workloads_with_meshes() {
  const support::ScratchFolder folder;
  for (const std::string& mesh : mesh_files) folder.file(mesh, "");
  const BenchSet set = regret_set(BenchEffort::thorough, folder.path(""));
  CHECK(set.missing.empty());
  return set.workloads;
}

template <class Value>
std::set<Value> values_of(const std::vector<BenchWorkload>& workloads, Value BenchWorkload::*member) {
  std::set<Value> values;
  for (const BenchWorkload& one : workloads) values.insert(one.*member);
  return values;
}

std::set<double> radii_of(const std::vector<BenchWorkload>& workloads) {
  std::set<double> radii;
  for (const BenchWorkload& one : workloads) radii.insert(one.disc_radius.value);
  return radii;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("an awkward disc is a function of the seed and its number") {
    for (const AwkwardScene scene : all_awkward) {
      CAPTURE(name(scene));
      const auto few = awkward_discs(scene, 10, 0.1, 7);
      const auto many = awkward_discs(scene, 30, 0.1, 7);
      const auto others = awkward_discs(scene, 10, 0.1, 8);
      REQUIRE(few.size() == 10);
      CHECK(std::equal(few.begin(), few.end(), many.begin(), is_same));
      CHECK_FALSE(std::equal(few.begin(), few.end(), others.begin(), is_same));
    }
  }

  TEST_CASE("awkward discs have isotropic unit normals, and one radius unless the radii are mixed") {
    constexpr std::size_t count = 5000;
    for (const AwkwardScene scene : all_awkward) {
      CAPTURE(name(scene));
      glm::dvec3 sum(0);
      const auto discs = awkward_discs(scene, count, 0.1, 1);
      for (const sim::Disc& disc : discs) {
        REQUIRE(glm::length(disc.normal) == doctest::Approx(1));
        sum += disc.normal;
      }
      CHECK(glm::length(sum) < 5 * std::sqrt(static_cast<double>(count)));
      CHECK((discs_where(discs, [](const auto& disc) { return disc.radius == 0.1; }) == count) ==
            (scene != AwkwardScene::mixed_radii));
    }
  }

  TEST_CASE("the largest of 20 clusters is 300 times as large as the smallest") {
    const auto discs = awkward_discs(AwkwardScene::clusters, 20'000, 0.001, 1);
    for (const std::size_t cluster : {0, 19}) {
      glm::dvec3 mean(0);
      for (std::size_t i = cluster; i < discs.size(); i += 20) mean += discs[i].centre / 1000.0;
      double square = 0;
      for (std::size_t i = cluster; i < discs.size(); i += 20)
        square += glm::dot(discs[i].centre - mean, discs[i].centre - mean) / 1000.0;
      CHECK(std::sqrt(square / 3) == doctest::Approx(cluster == 0 ? 0.1 : 0.0003).epsilon(0.1));
    }
  }

  TEST_CASE("half of the discs lie on the floor, half on a ball with a hundredth of its side as diameter") {
    const auto discs = awkward_discs(AwkwardScene::tiny_object, 2000, 0.001, 1);
    CHECK(discs_where(discs, [](const auto& disc) { return disc.centre.y == 0 && is_in_cube(disc.centre); }) == 1000);
    const glm::dvec3 middle = discs[1].centre;
    CHECK(discs_where(discs, [&](const auto& disc) { return glm::length(disc.centre - middle) <= 0.0101; }) >= 1000);
  }

  TEST_CASE("a thin sheet has no thickness, and five of the strays lie far outside the cube of the others") {
    const auto sheet = awkward_discs(AwkwardScene::thin_sheet, 1000, 0.001, 1);
    CHECK(discs_where(sheet, [](const auto& disc) { return disc.centre.y == 0 && is_in_cube(disc.centre); }) == 1000);
    const auto strays = awkward_discs(AwkwardScene::strays, 1000, 0.001, 1);
    CHECK(discs_where(strays, [](const auto& disc) { return is_in_cube(disc.centre); }) == 995);
    CHECK(discs_where(strays, [](const auto& disc) { return glm::length(disc.centre) > 100; }) == 5);
  }

  TEST_CASE("mixed radii are log-normal: the median is the radius, a factor of e one standard deviation") {
    const auto discs = awkward_discs(AwkwardScene::mixed_radii, 10'000, 0.01, 1);
    const auto share_below = [&](double radius) {
      return static_cast<double>(discs_where(discs, [&](const auto& disc) { return disc.radius < radius; })) / 1e4;
    };
    CHECK(share_below(0.01) == doctest::Approx(0.5).epsilon(0.05));
    CHECK(share_below(0.01 * std::exp(1)) == doctest::Approx(0.841).epsilon(0.02));
    CHECK(share_below(0.01 * std::exp(-2)) == doctest::Approx(0.0228).epsilon(0.3));
  }

  TEST_CASE("there are at least 300 workloads, of all radii, numbers of rays and both fields in both halves") {
    const auto workloads = workloads_with_meshes();
    CHECK(workloads.size() >= 300);
    for (const bool held_out : {false, true}) {
      CAPTURE(held_out);
      std::vector<BenchWorkload> half;
      for (const BenchWorkload& one : workloads)
        if (one.held_out == held_out) half.push_back(one);
      CHECK(half.size() >= 100);
      CHECK(radii_of(half) == std::set{0.0025, 0.01, 0.04, 0.16});
      CHECK(values_of(half, &BenchWorkload::rays) == std::set{1e2, 1e3, 1e4, 1e5, 1e6});
      CHECK(values_of(half, &BenchWorkload::field).size() == 2);
    }
  }

  TEST_CASE("no scene is in both halves, all meshes are held out, and no workload occurs twice") {
    const auto workloads = workloads_with_meshes();
    std::map<std::string, std::set<bool>> halves;
    std::set<std::tuple<std::string, sim::Field, std::optional<double>, double, double>> distinct;
    for (const BenchWorkload& one : workloads) {
      halves[one.scene].insert(one.held_out);
      distinct.insert({one.scene, one.field, one.samples, one.disc_radius.value, one.rays});
    }
    CHECK(distinct.size() == workloads.size());
    CHECK(halves.size() == 14);
    for (const auto& half : halves) CHECK(half.second.size() == 1);
    CHECK(halves.at("sponza") == std::set{true});
    CHECK(halves.at("@tree") == std::set{false});
  }

  TEST_CASE("the quick effort is small, needs no meshes, and has both halves and all radii") {
    const BenchSet set = regret_set(BenchEffort::quick, "");
    CHECK(set.missing.empty());
    CHECK(set.workloads.size() >= 20);
    CHECK(set.workloads.size() <= 40);
    CHECK(values_of(set.workloads, &BenchWorkload::held_out).size() == 2);
    CHECK(radii_of(set.workloads).size() == 4);
    CHECK(values_of(set.workloads, &BenchWorkload::rays) == std::set{1e3, 1e4});
    CHECK(values_of(set.workloads, &BenchWorkload::scene).size() == 9);
    for (const BenchWorkload& one : set.workloads) CHECK((one.samples > 0 && one.samples <= 1e4));
  }

  TEST_CASE("families have the same workloads for a seed, two scenes of each, others for another seed" *
            doctest::test_suite("long")) {
    const auto workloads = family_workloads(3);
    CHECK(workloads.size() == 84);
    CHECK(values_of(workloads, &BenchWorkload::scene).size() == 12);
    for (const BenchWorkload& one : workloads) {
      CHECK(one.held_out);
      CHECK((one.disc_radius.value >= 0.0025 && one.disc_radius.value <= 0.16));
      CHECK((one.rays >= 100 && one.rays <= 1e6));
    }
    CHECK(values_of(family_workloads(3), &BenchWorkload::rays) == values_of(workloads, &BenchWorkload::rays));
    CHECK(values_of(family_workloads(4), &BenchWorkload::rays) != values_of(workloads, &BenchWorkload::rays));
    CHECK_FALSE(make_bench_job(workloads.front(), 1).discs.empty());
  }

  TEST_CASE("meshes that are missing are named, with the reason") {
    const BenchSet unknown = regret_set(BenchEffort::thorough, "");
    REQUIRE(unknown.missing.size() == mesh_files.size());
    CHECK(unknown.missing[0] == "stanford_bunny: DETP_SCENES, the folder of its file, is not set");
    const BenchSet absent = regret_set(BenchEffort::thorough, "/nowhere");
    CHECK(absent.missing[1] == "sponza: /nowhere/sponza.ply does not exist");
  }

  TEST_CASE("the job has the rays, discs and radius of the workload, from a scene or made") {
    const BenchWorkload uniform{.scene = "@uniform",
                                .discs = "@uniform",
                                .samples = 200,
                                .disc_radius = {0.04, true},
                                .rays = 100,
                                .held_out = false};
    const BenchWorkload sheet{.scene = "thin-sheet",
                              .discs = AwkwardScene::thin_sheet,
                              .samples = 200,
                              .disc_radius = {0.04, true},
                              .rays = 100};
    for (const BenchWorkload& workload : {uniform, sheet}) {
      CAPTURE(workload.scene);
      const Job job = make_bench_job(workload, 1);
      CHECK(job.rays.size() == 100);
      CHECK(job.discs.size() == 200);
      CHECK(job.workload().rays == 100);
      CHECK(job.workload().samples == 200);
      CHECK(job.workload().disc_radius / scene_side(job.workload()) == doctest::Approx(0.04).epsilon(0.1));
    }
  }
}
