#include "detp/validate/choice/plan_memory_file.hpp"

#include <doctest/doctest.h>

#include <string>

#include "detp/sim/files/file_error.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using validate::PlanMemory;

namespace {

void fill_with_three(PlanMemory& memory) {
  memory.remember({.rays = 10, .discs = 12, .spacing = -3, .dimension = 9, .path_length = -2, .front_facing = true},
                  {.candidate = {Technique::box_tree, BoxTreeParameters{8, 32}},
                   .threads = 2,
                   .predicted_seconds = 0.1,
                   .predicted_error = 1e-3,
                   .rigor = Rigor::pilot,
                   .cut_off = true});
  memory.remember({.rays = 3, .path_length = validate::WorkloadClass::lines},
                  {.candidate = {Technique::sphere_cache, SphereCacheParameters{0.5, 4, SampleOrder::hilbert}},
                   .predicted_seconds = 7,
                   .rigor = Rigor::structural});
  memory.remember({}, {.candidate = default_candidate(Technique::brute_force)});
}

std::string replaced_in(std::string text, const std::string& what, const std::string& by) {
  const std::size_t place = text.find(what);
  REQUIRE(place != std::string::npos);
  return text.replace(place, what.size(), by);
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a memory is read back as it was written, and added to what is there") {
    PlanMemory memory;
    fill_with_three(memory);
    const support::ScratchFolder folder;
    const std::string path = folder.path("made/for/it/plans.json");
    validate::write_plan_memory(path, memory);
    PlanMemory read;
    read.remember({.rays = 1}, {});
    CHECK(validate::read_plan_memory(path, read).empty());
    CHECK(read.size() == memory.size() + 1);
    for (const PlanMemory::Entry& entry : memory.entries())
      CHECK(read.find(entry.workload, Rigor::estimate) == entry.choice);
    PlanMemory again;
    CHECK(validate::parse_plan_memory(validate::plan_memory_text(memory), path, again).empty());
    CHECK(again.entries() == memory.entries());
  }

  TEST_CASE("a missing file is an empty memory, without a warning") {
    PlanMemory memory;
    CHECK(validate::read_plan_memory("/nowhere/plans.json", memory).empty());
    CHECK(memory.size() == 0);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a file of another machine is not used, with a word of why") {
    PlanMemory memory;
    fill_with_three(memory);
    const std::string good = validate::plan_memory_text(memory);
    PlanMemory read;
    const std::string stale = validate::parse_plan_memory(
        replaced_in(good, "\"instruction_set\": \"", "\"instruction_set\": \"un"), "p.json", read);
    CHECK(stale.find("p.json: not used: its instruction set is un") == 0);
    CHECK(stale.find(", here it is ") != std::string::npos);
    CHECK(read.size() == 0);
  }

  TEST_CASE("nothing of a broken file is used, and the warning names the file") {
    PlanMemory memory;
    fill_with_three(memory);
    const std::string good = validate::plan_memory_text(memory);
    for (const std::string& bad : {std::string(),
                                   std::string("{"),
                                   std::string("[]"),
                                   std::string("null"),
                                   std::string("{\"schema\": 1}"),
                                   std::string(100'000, '['),
                                   good.substr(0, good.size() / 2),
                                   replaced_in(good, "detp.plans", "detp.run"),
                                   replaced_in(good, "\"version\": 1", "\"version\": 2"),
                                   replaced_in(good, "\"log2_rays\": 10", "\"log2_rays\": 1e300"),
                                   replaced_in(good, "\"log2_rays\": 10", "\"log2_rays\": 0.5"),
                                   replaced_in(good, "\"log2_rays\": 10", "\"log2_rays\": \"x\""),
                                   replaced_in(good, "\"pilot\"", "\"guess\""),
                                   replaced_in(good, "\"box-tree\"", "\"tree\""),
                                   replaced_in(good, "\"box-tree\"", "\"photon-map\""),
                                   replaced_in(good, "\"fan_out\": 8", "\"fan_out\": 1"),
                                   replaced_in(good, "\"fan_out\": 8", "\"fan_out\": 1e30"),
                                   replaced_in(good, "\"fan_out\": 8", "\"fan_in\": 8"),
                                   replaced_in(good, "\"fan_out\": 8", "\"fan_out\": 18446744073709551615"),
                                   replaced_in(good, "\"hilbert\"", "\"\\ud800\""),
                                   replaced_in(good, "\"hilbert\"", "\"x\\u001b\""),
                                   replaced_in(good, "\"predicted_seconds\": 0.1", "\"predicted_seconds\": -1"),
                                   replaced_in(good, "\"threads\": 2", "\"threads\": 1e9"),
                                   replaced_in(good, "\"cut_off\": true", "\"cut_off\": 1")}) {
      CAPTURE(bad.substr(0, 2000));
      PlanMemory read;
      const std::string warning = validate::parse_plan_memory(bad, "p.json", read);
      CHECK(warning.find("p.json: not used: ") == 0);
      CHECK(warning.size() < 400);
      CHECK(warning.find('\x1b') == std::string::npos);
      CHECK(read.size() == 0);
    }
  }

  TEST_CASE("what cannot be read or written") {
    const support::ScratchFolder folder;
    PlanMemory memory;
    const std::string warning = validate::read_plan_memory(folder.path(""), memory);  // a folder
    CHECK(warning.find("; not used") != std::string::npos);
    CHECK_THROWS_AS(validate::write_plan_memory("/proc/nothing/plans.json", memory), sim::FileError);
  }
}
