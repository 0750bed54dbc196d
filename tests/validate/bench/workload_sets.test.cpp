#include "detp/validate/bench/workload.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

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

  TEST_CASE("families have the same workloads for a seed, two scenes of each, others for another seed") {
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
