#include <doctest/doctest.h>

#include "support/command.hpp"

namespace detp::support {
namespace {

const std::string small = "bench @cornell --field photons --rays 200,1000 --disc-radius 1%,0.05 --repeat 2 ";

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("bench has a row for each competitor on each workload, and a summary that follows from the rows") {
    const Json json = result_of(small + "--threads 1");
    CHECK(json.at("schema").at("name") == "detp.bench");
    CHECK(json.at("inputs").at("workloads") == 4);
    CHECK(json.at("skipped").empty());
    std::size_t embree = 0;
    for (const Json& row : json.at("rows")) {
      CAPTURE(row.dump());
      CHECK(row.at("scene") == "@cornell");
      CHECK(row.at("field") == "photons");
      CHECK(row.at("threads") == 1);
      CHECK(row.at("seconds").get<double>() > 0);
      CHECK(row.at("parameters").is_object());
      CHECK(row.at("right_hits_by") == "brute-force");
      const bool peer = row.at("technique") == "embree";
      embree += peer ? 1 : 0;
      CHECK(row.at("wrong_hits").get<double>() <= (peer ? 3 : 0));
    }
    CHECK(embree == 4 * json.at("inputs").at("embree_modes").size());
    CHECK(json.at("rows").size() > embree);
    const Json& summary = json.at("summary").at("against_embree");
    CHECK(summary.at("races") == 4);
    CHECK(summary.at("geometric_mean").get<double>() >= summary.at("worst").get<double>());
    const Json& worst = summary.at("worst_row");
    CHECK(worst.at("embree").at("seconds").get<double>() / worst.at("ours").at("seconds").get<double>() ==
          doctest::Approx(summary.at("worst").get<double>()));
    CHECK(json.at("summary").at("ours_agree") == true);
  }

  TEST_CASE("bench's CSV has a line for each row, also without a closed form, and its text the summary") {
    const Finished csv = detp(small + "--threads 2 --techniques grid,brute-force --format csv");
    CHECK(csv.code == 0);
    CHECK(csv.out.starts_with("scene,field,rays,samples,disc_radius,threads,technique,"));
    CHECK(csv.out.find(",2,grid,") != std::string::npos);
    CHECK(csv.out.find("sphere-tree") == std::string::npos);
    const Finished defaults = detp("bench @uniform --samples 100 --rays 50 --techniques bvh --repeat 1 --format csv");
    CHECK(defaults.code == 0);
    CHECK(defaults.out.find(",bvh,") != std::string::npos);
    const Finished text = detp("bench @uniform --samples 100 --rays 50 --disc-radius 10% --repeat 1 --threads 1");
    CHECK(text.code == 0);
    CHECK(text.out.find("ours all agree") != std::string::npos);
    CHECK(text.out.find("geometric mean") != std::string::npos);
  }

  TEST_CASE("bench races with the instruction sets that are named, ours and Embree's, and sums up each") {
    if (__builtin_cpu_supports("sse4.2") == 0) {
      MESSAGE("skipped: the processor has no SSE4");
      return;
    }
    const std::string one = "bench @cornell --field photons --rays 200 --disc-radius 1% --repeat 1 --threads 1 ";
    const Json json = result_of(one + "--instruction-set SSE4,SSE4");
    CHECK(json.at("summary").at("by_instruction_set").size() == 2);
    for (const Json& summary : json.at("summary").at("by_instruction_set")) {
      CHECK(summary.at("instruction_set") == "SSE4");
      CHECK(summary.at("against_embree").at("races") == 1);
    }
    for (const Json& row : json.at("rows")) CHECK(row.at("instruction_set") == "SSE4");
    CHECK(json.at("summary").at("ours_agree") == true);
    CHECK(detp(one + "--instruction-set SSE4").out.find("\nSSE4\n") != std::string::npos);
  }

  TEST_CASE("instruction sets that the kernels, the machine or Embree lack are refused") {
    const std::string one = "bench @cornell --rays 200 --disc-radius 1% ";
    for (const char* set : {"MMX", "SCALAR", "sse4"}) {
      CAPTURE(set);
      const Finished finished = detp(one + "--instruction-set " + set);
      CHECK(finished.code == 2);
      CHECK(finished.err.find("instruction set") != std::string::npos);
    }
    CHECK(detp("bench --regret --instruction-set SSE4,SSE4").err.find("takes only one here") != std::string::npos);
    CHECK(detp("calibrate --instruction-set MMX").code == 2);
  }

  TEST_CASE("a bench that is stopped shows its results so far and ends with code 3") {
    const Finished finished = detp("bench @uniform --rays 1e5 --disc-radius 1% --time-limit 0.3 --format json");
    CHECK(finished.code == 3);
    CHECK(finished.err.empty());
    CHECK(finished.json().at("stopped") == true);
  }

  TEST_CASE("bench refuses what it cannot run, with the reason") {
    check_refused({{"bench @nowhere", "@nowhere"},
                   {"bench @tree --rays 0", "--rays"},
                   {"bench @tree --rays 1e3,x", "--rays"},
                   {"bench @tree --samples 0.5", "--samples"},
                   {"bench @tree --disc-radius 1%,-2%", "disc radius"},
                   {"bench @tree --field sideways", "sideways"},
                   {"bench @tree --effort great", "great"},
                   {"bench @tree --repeat 0", "--repeat"},
                   {"bench @tree --most-hits -1", "--most-hits"},
                   {"bench @tree --techniques grid,none", "none"},
                   {"bench @tree --techniques sphere-cache-published", "does not find all hits"},
                   {"bench @tree --techniques photon-map", "does not find all hits"},
                   {"bench @uniform --field photons", "light"},
                   {"bench missing.obj", "missing.obj"}});
  }
}

}  // namespace detp::support
