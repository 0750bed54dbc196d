#include <doctest/doctest.h>

#include "detp/validate/cli/bench/bench_report.hpp"
#include "support/command.hpp"
#include "support/csv_answer.hpp"
#include "support/regret_rows.hpp"

namespace detp::support {
namespace {

const std::string small = "bench @cornell --field photons --rays 200,1000 --disc-radius 1%,0.05 --repeat 2 ";

cli::Result report_of(std::vector<validate::RegretRow> rows, const std::vector<int>& threads = {1}) {
  validate::RegretAnswer answer{.set = {{}, {"sponza: not here"}}, .threads = threads};
  answer.result.rows = std::move(rows);
  answer.result.workloads = answer.result.done = answer.result.rows.size();
  answer.summarise_all();
  return cli::report(answer, {});
}

validate::RegretRow at_least(validate::RegretRow row) {
  row.baselines.back()[0]->at_least = true;
  return row;
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("bench has a row for each competitor on each workload, and a summary that follows from the rows" *
            doctest::skip(!has_embree)) {
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
    const Finished defaults = detp("bench @uniform --samples 100 --rays 50 --techniques bsp --repeat 1 --format csv");
    CHECK(defaults.code == 0);
    CHECK(defaults.out.find(",bsp,") != std::string::npos);
    const Finished text = detp("bench @uniform --samples 100 --rays 50 --disc-radius 10% --repeat 1 --threads 1");
    CHECK(text.code == 0);
    CHECK(text.out.find("ours all agree") != std::string::npos);
    CHECK(text.out.find(has_embree ? "geometric mean" : "without Embree") != std::string::npos);
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
      if (has_embree) CHECK(summary.at("against_embree").at("races") == 1);
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

  TEST_CASE("bench --regret that is stopped shows its results so far and ends with code 3" *
            doctest::test_suite("long")) {
    const Finished finished = detp("bench --regret --time-limit 0.2 --format json");
    CHECK(finished.code == 3);
    CHECK(finished.err.empty());
    CHECK(finished.json().at("stopped") == true);
    CHECK(finished.json().at("stopped_after").at("unit") == "workloads");
    CHECK(finished.json().at("inputs").at("regret") == true);
  }

  TEST_CASE("bench --regret refuses what it cannot run, with the reason") {
    check_refused({{"bench --regret nowhere", "@courtyard"},
                   {"bench --regret @uniform --field photons", "photons"},
                   {"bench --regret --effort great", "great"},
                   {"bench --regret --rays 100", "--regret"},
                   {"bench --regret --samples 100", "--regret"},
                   {"bench --regret --disc-radius 1%", "--regret"},
                   {"bench --regret --techniques grid", "--regret"},
                   {"bench --regret --embree-modes all", "--regret"},
                   {"bench --regret --repeat 3", "--regret"},
                   {"bench --regret --most-hits 1e5", "--regret"},
                   {"bench --regret --costs t=x", "t"},
                   {"bench --regret --calibration missing.json", "missing.json"},
                   {"bench @tree --costs t=x", "t"},
                   {"bench @tree --calibration missing.json", "missing.json"}});
  }
}

TEST_SUITE("long") {
  TEST_CASE("bench --regret on one scene has its workloads and their figures") {
    const Json json = result_of("bench --regret @uniform --threads 2 --calibration none");
    CHECK(json.at("inputs").at("scenes") == Json{"@uniform"});
    const std::size_t workloads = json.at("inputs").at("workloads");
    CHECK(json.at("rows").size() == json.at("summary").at("tiers").size() * workloads);
    for (const Json& row : json.at("rows")) {
      CHECK(row.at("scene") == "@uniform");
      CHECK(row.at("threads") == 2);
      CHECK(row.at("held_out") == false);
    }
    const Json& summary = json.at("summary");
    CHECK(summary.at("threads") == 2);
    CHECK(summary.at("regret").at("estimate").at("fitted").at("workloads") == workloads);
    CHECK(summary.at("regret").at("estimate").at("held_out").at("geometric_mean").is_null());
    CHECK(json.at("unit_costs").get<std::string>().find("built in") != std::string::npos);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("the JSON of --regret has the figures of tiers and baselines, in all and by halves and threads") {
    const auto json = report_of({regret_row(2, false), regret_row(8, true), regret_row(3, true, 2, 2)}, {1, 2}).json;
    const auto& regret = json.at("summary").at("regret");
    for (const char* who :
         {"estimate", "best_constant", "usual_shape", "paper_rule", "always_embree", "always_brute_force"})
      for (const char* figure : {"geometric_mean", "p95", "worst"}) {
        CHECK(regret.at(who).at(figure).get<double>() > 1);
        CHECK(regret.at(who).at("fitted").contains(figure));
        CHECK(regret.at(who).at("held_out").contains(figure));
      }
    CHECK(regret.at("estimate").at("geometric_mean").get<double>() == doctest::Approx(4));
    CHECK(regret.at("estimate").at("fitted").at("worst") == 2);
    CHECK(regret.at("estimate").at("held_out").at("worst") == 8);
    CHECK(regret.at("best_constant").at("technique") == "box-tree");
    CHECK_FALSE(regret.at("paper_rule").contains("technique"));
    CHECK(json.at("summary").at("prediction").at("median_error").get<double>() == doctest::Approx(0.6875));
    CHECK(json.at("summary").at("prediction").contains("p95_error"));
    CHECK(json.at("summary").at("price").at("geometric_mean").get<double>() == doctest::Approx(std::sqrt(2.5 * 8.5)));
    CHECK(json.at("summary").at("noise").at("geometric_mean") == 1);
    REQUIRE(json.at("summary").at("by_threads").size() == 2);
    CHECK(json.at("summary").at("by_threads")[1].at("regret").at("estimate").at("worst") == 3);
    CHECK(json.at("rows").size() == 3);
    CHECK(json.at("left_out").size() == 1);
  }

  TEST_CASE("the CSV of --regret has a row for each workload, number of threads and tier") {
    const auto rows = csv_records(report_of({at_least(regret_row(2, false)), regret_row(8, true)}).csv);
    REQUIRE(rows.size() == 3);
    CHECK(rows[0].front() == "scene");
    CHECK(rows[0].back() == "reason");
    const auto field = [&](std::size_t row, const std::string& column) {
      const auto place = std::find(rows[0].begin(), rows[0].end(), column) - rows[0].begin();
      REQUIRE(place < std::ssize(rows[0]));
      return rows[row].at(static_cast<std::size_t>(place));
    };
    CHECK(field(1, "scene") == "@tree");
    CHECK(field(1, "held_out") == "false");
    CHECK(field(2, "held_out") == "true");
    CHECK(field(1, "rays") == "1200");
    CHECK(field(1, "tier") == "estimate");
    CHECK(field(1, "technique") == "box-tree");
    CHECK(field(1, "best_technique") == "grid");
    CHECK(field(1, "regret") == "2");
    CHECK(field(1, "always_brute_force_regret") == "2");
    CHECK(field(1, "always_brute_force_abandoned") == "true");
    CHECK(field(2, "always_brute_force_abandoned") == "false");
    CHECK(field(1, "reason") == "unit costs");
  }

  TEST_CASE("the text of --regret has a line for each tier and baseline, marks lower bounds, and lists the worst") {
    const std::string text = report_of({at_least(regret_row(2, false)), regret_row(8, true)}).text;
    CAPTURE(text);
    CHECK(text.find("best constant") != std::string::npos);
    CHECK(text.find(">= 2") != std::string::npos);
    CHECK(text.find("at least") != std::string::npos);
    CHECK(text.find("The 2 largest regrets") != std::string::npos);
    CHECK(text.find("left out  sponza: not here") != std::string::npos);
    CHECK_FALSE(has_no_number(text));
  }

  TEST_CASE("without rows, the report of --regret has no figures and is no error") {
    const cli::Result empty = report_of({});
    CHECK(empty.json.at("rows").empty());
    CHECK(empty.json.at("summary").at("regret").empty());
    CHECK(empty.text.find("0 workloads") != std::string::npos);
  }
}

}  // namespace detp::support
