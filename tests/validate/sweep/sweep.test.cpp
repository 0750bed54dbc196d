#include "detp/validate/sweep/sweep.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "support/scratch_file.hpp"
#include "support/sealed.hpp"

using namespace detp;
using namespace detp::validate;
using support::content_of;
using support::file_error_of;
using support::ScratchFolder;

namespace {

std::vector<SweepPoint> small_points() { return {{3, 300, 0.05, 4, 40}, {2, 200, 0.2, 4, 40}}; }

std::vector<double> numbers(const SweepResult& result) {
  std::vector<double> all;
  for (const Deviation& row : result.deviations)
    for (const double number : {row.predicted, row.observed.mean, row.observed.standard_error}) all.push_back(number);
  return all;
}

Deviation row(double predicted, double error = 0, Form form = Form::corrected) {
  Deviation made;
  made.technique = "sphere-cache";
  made.quantity = "m_i";
  made.form = form;
  made.predicted = predicted;
  made.observed = {100, error};
  return made;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a summary has the median, the worst and the number beyond the goal; noisy rows are counted apart") {
    std::vector<Deviation> rows{row(101), row(97), row(100), row(115), row(111, 0.4), row(112, 1)};
    rows.push_back(row(300, 5));  // a standard error of 5 % is too large to check 10 %
    rows.push_back(row(1000, 0, Form::published));
    const auto summaries = summarise(rows);
    REQUIRE(summaries.size() == 2);
    const DeviationSummary& corrected = summaries[0];
    CHECK(corrected.form == Form::corrected);
    CHECK(corrected.compared == 6);
    CHECK(corrected.noisy == 1);
    CHECK(corrected.beyond == 1);  // 15 %; 11 ± 0.4 % and 12 ± 1 % are within three standard errors of 10 %
    CHECK(corrected.median == doctest::Approx(0.07));  // of 0, 1, 3, 11, 12, 15 %
    CHECK(corrected.worst == doctest::Approx(0.15));
    CHECK(corrected.worst_at.predicted == 115);
    CHECK_FALSE(corrected.met());
    CHECK(summaries[1].worst == doctest::Approx(9));
  }

  TEST_CASE("a summary without a row beyond the goal meets the goal") {
    const std::vector<Deviation> rows{row(101), row(97)};
    CHECK(summarise(rows).front().met());
  }
}

TEST_SUITE("sweep") {
  TEST_CASE("the points cover the stated range") {
    const auto points = sweep_points();
    for (const int dimension : {2, 3})
      for (const double samples : {1e3, 1e4, 1e5, 1e6, 1e7})
        for (const double share : {1e-4, 1e-3, 1e-2, 0.05, 0.2})
          CHECK(std::count_if(points.begin(), points.end(), [&](const SweepPoint& point) {
                  return point.dimension == dimension && point.samples == samples && point.disc_share == share;
                }) == 1);
    for (const SweepPoint& point : points)
      CHECK(point.disc_radius() / point.workload().sphere_radius == doctest::Approx(point.disc_share));
  }

  TEST_CASE("the points together cover box trees of every fan-out with every leaf size, in volumes and on surfaces") {
    std::set<std::tuple<int, int, int>> trees;
    for (const SweepPoint& point : sweep_points())
      for (const Candidate& candidate : sweep_candidates(point))
        if (const auto* tree = std::get_if<BoxTreeParameters>(&candidate.parameters))
          trees.insert({point.dimension, tree->fan_out, tree->leaf});
    for (const int dimension : {2, 3})
      for (const int fan_out : {2, 4, 8, 16})
        for (const int leaf : {1, 4, 16, 64, 256}) CHECK(trees.contains({dimension, fan_out, leaf}));
  }

  TEST_CASE("every quantity is compared with each form that predicts it") {
    const SweepResult result = run_sweep(small_points());
    CHECK(result.points == 2);
    CHECK(result.measured == 2);
    const auto has = [&](std::string_view technique, std::string_view quantity, Form form) {
      return std::any_of(result.deviations.begin(), result.deviations.end(), [&](const Deviation& one) {
        return one.technique == technique && one.quantity == quantity && one.form == form && one.predicted > 0 &&
               one.observed.mean > 0;
      });
    };
    for (const Form form : {Form::published, Form::corrected}) {
      CHECK(has("sphere-cache", "m_i", form));
      CHECK(has("sphere-cache", "cull_tests", form));
      CHECK(has("octree", "disc_tests", form));
    }
    CHECK(has("sphere-cache", "L_i", Form::corrected));
    CHECK(has("grid", "steps", Form::corrected));
    for (const char* quantity : {"cull_tests", "culls", "listed", "visits", "disc_tests", "hits"})
      CHECK(has("box-tree", quantity, Form::corrected));
  }
}

TEST_SUITE("sweep") {
  TEST_CASE("the rows of a sweep hold both forms of a prediction beside one observation; exact counts have no row") {
    Deviation count{.technique = "sphere-cache",
                    .parameters = "Q 0.5, k 3",
                    .quantity = "m_i",
                    .sphere = 2,
                    .form = Form::published,
                    .predicted = 123456.7,
                    .observed = {120000, 350}};
    count.samples = 1e4;
    count.disc_share = 0.01;
    Deviation corrected = count;
    corrected.form = Form::corrected;
    corrected.predicted = 119000;
    Deviation other = corrected;
    other.sphere = 3;
    Deviation exact = corrected;
    exact.sphere = 4;
    exact.observed = {119000, 0};
    const ScratchFolder folder;
    write_sweep_rows(folder.path("rows"), {count, corrected, other, exact});
    CHECK(content_of(folder.path("rows")) ==
          "dimension,samples,disc_share,technique,parameters,quantity,sphere,published,corrected,observed,"
          "standard_error\n"
          "3,10000,0.01,sphere-cache,\"Q 0.5, k 3\",m_i,2,1.2346e+05,1.19e+05,1.2e+05,3.5e+02\n"
          "3,10000,0.01,sphere-cache,\"Q 0.5, k 3\",m_i,3,,1.19e+05,1.2e+05,3.5e+02\n");
  }
}

TEST_SUITE("checkpoint") {
  TEST_CASE("a resumed sweep gives the same result as an uninterrupted one") {
    const ScratchFolder folder;
    const SweepResult whole = run_sweep(small_points());
    SweepOptions options{.checkpoint = folder.path("sweep.json")};
    const auto both = small_points();
    CHECK(numbers(run_sweep(both, options)) == numbers(whole));
    // As if the sweep had been interrupted before the second point.
    const std::string content = content_of(folder.path("sweep.json"));
    auto first = nlohmann::json::parse(content);
    REQUIRE(first.at("state").size() == 2);
    first["state"].erase(both[1].name());
    folder.file("sweep.json", support::sealed_checkpoint(first));
    options.resume = true;
    const SweepResult resumed = run_sweep(both, options);
    CHECK(resumed.resumed == 1);
    CHECK(resumed.measured == 2);
    CHECK(numbers(resumed) == numbers(whole));
    CHECK(content_of(folder.path("sweep.json")) == content);
  }

  TEST_CASE("a file of another seed, of other points, or no checkpoint at all is refused and left unchanged") {
    const ScratchFolder folder;
    SweepOptions options{.checkpoint = folder.path("sweep.json"), .resume = true};
    const auto points = small_points();
    (void)run_sweep(points, options);
    const std::string content = content_of(folder.path("sweep.json"));
    options.seed = 2;
    CHECK(file_error_of([&] { (void)run_sweep(points, options); }).find("made with seed 1, not 2") !=
          std::string::npos);
    options.seed = 1;
    CHECK(file_error_of([&] { (void)run_sweep(std::vector{points[0]}, options); }).find("digest of formulas") !=
          std::string::npos);
    CHECK(content_of(folder.path("sweep.json")) == content);
    for (const std::string bad : {"", "{", "[]", "{\"schema\":{\"name\":\"x\",\"version\":1}}", "null"}) {
      folder.file("sweep.json", bad);
      CHECK(file_error_of([&] { (void)run_sweep(points, options); }).find("not a checkpoint") != std::string::npos);
      CHECK(content_of(folder.path("sweep.json")) == bad);
    }
  }

  TEST_CASE("a stop before the start measures nothing") {
    std::stop_source stop;
    stop.request_stop();
    const SweepResult result = run_sweep(small_points(), {.stop = stop.get_token()});
    CHECK(result.measured == 0);
    CHECK(result.deviations.empty());
  }
}
