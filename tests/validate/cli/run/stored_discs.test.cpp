#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/candidate_json.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/choice/plan.hpp"
#include "detp/validate/job/job.hpp"
#include "support/attempts.hpp"
#include "support/command.hpp"
#include "support/machine.hpp"
#include "support/scratch_file.hpp"

using detp::support::Finished;
using detp::support::ScratchFolder;
using namespace detp::sim;
using namespace detp;

namespace {

struct Found {
  Finished finished;
  std::string per_disc;
  std::string pairs;
};

/// `pairs`: also writes them.
Found found(const ScratchFolder& folder, const std::string& line, bool pairs) {
  const std::string per_disc = folder.path("per_disc.csv");
  const std::string pair_file = folder.path("pairs.csv");
  Found result{detp::support::detp(line + " --threads 2 --standard-error --format json --per-disc " + per_disc +
                                   (pairs ? " --pairs " + pair_file : "")),
               {},
               {}};
  CAPTURE(result.finished.err);
  REQUIRE(result.finished.code == 0);
  result.per_disc = detp::support::content_of(per_disc);
  if (pairs) result.pairs = detp::support::content_of(pair_file);
  return result;
}

/// What the program takes itself, in addition to the data that --memory-limit is about: the peak of a run of next to nothing.
double peak_of_program(const ScratchFolder& folder) {
  return found(folder, "run --samples 10 --scene-side 1 --disc-radius 0.01 --rays 10 --technique octree", false)
      .finished.peak_bytes;
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("discs of a file that do not fit in memory are searched in parts: the same bytes, and the limit holds" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    std::vector<Disc> discs = uniform_discs(Body::cube, 2, 600'000, 0.01, 3);
    for (std::size_t i = 0; i < discs.size(); i += 4) discs[i].radius = 0.02;
    const std::string file = folder.file("discs.ply", detp::support::disc_ply(discs));  // 34 MB
    const std::string rays = folder.path("rays.csv");
    for (const std::string& rest :
         {std::string(" --rays 50000"), std::string(" --rays 20000 --technique octree --field mixed:0.5:0.3:0.2")}) {
      CAPTURE(rest);
      const Found all = found(folder, "run --discs " + file + rest, true);
      const Found parts = found(folder, "run --discs " + file + rest + " --memory-limit 80M", true);
      CHECK(all.finished.err.find("do not fit") == std::string::npos);
      CHECK(parts.finished.err.find("the 600000 discs do not fit in memory") != std::string::npos);
      CHECK(parts.per_disc == all.per_disc);
      CHECK(parts.pairs == all.pairs);
      const auto a = all.finished.json();
      const auto b = parts.finished.json();
      for (const char* same : {"hits", "hits_per_disc", "mean_irradiance", "rays", "photons"})
        CHECK(a.at(same) == b.at(same));
      if (!detp::support::sanitized) {
        CHECK(parts.finished.peak_bytes - peak_of_program(folder) < 80.0 * (1 << 20));
        CHECK(detp::support::in_attempts(3, [&] {  // a busy machine may not look at the memory in time
          return found(folder, "run --discs " + file + rest, true).finished.peak_bytes > 120.0 * (1 << 20);
        }));
      }
    }
  }

  TEST_CASE("discs in memory whose index does not fit are searched in parts, however few rays there are" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string line = "run --samples 300000 --scene-side 1 --disc-radius 0.003 --rays 100000 --technique octree";
    const Found all = found(folder, line, false);
    const Found parts = found(folder, line + " --memory-limit 70M", false);
    CHECK(parts.per_disc == all.per_disc);
    CHECK(parts.finished.json().at("hits") == all.finished.json().at("hits"));
    if (detp::support::sanitized) return;
    CHECK(parts.finished.peak_bytes - peak_of_program(folder) < 70.0 * (1 << 20));
    CHECK(parts.finished.peak_bytes < 0.9 * all.finished.peak_bytes);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("detp run, a plan that is executed once, and choose(Question) choose the same, with the same prediction" *
            doctest::test_suite("long")) {
    int piloted = 0;
    for (const char* scene : {"@cornell", "@tree-coarse", "@interior"})
      for (const double rays : {20.0, 3000.0, 1'000'000.0}) {
        INFO("scene ", scene, ", rays ", rays);
        const auto run = support::result_of(
            fmt::format("run {} --rays {} --disc-radius 2% --calibration none --threads 1", scene, rays));
        validate::JobRequest request;
        request.scene = scene;
        request.rays = rays;
        request.disc_radius = validate::Length{0.02, true};
        const validate::Job job = validate::make_job(request);
        const auto plan = validate::plan(job.discs, job.rays, {.once = true});
        CHECK(run["technique"] == name(plan.candidate().technique));
        CHECK(run["parameters"] == nlohmann::json(to_json(plan.candidate())));
        const sim::Problem& problem = job.problem();
        const auto choice = validate::choose({.problem = &problem, .purpose = validate::Purpose::one_search},
                                             validate::built_in_unit_costs());
        CHECK(plan.candidate() == choice.best().candidate);
        CHECK(plan.threads() == choice.best().threads);
        CHECK(plan.predicted_seconds() == doctest::Approx(choice.best().seconds()));
        piloted += choice.sampled_rays > 0 ? 1 : 0;
      }
    CHECK(piloted >= 3);
  }

  TEST_CASE("predicted seconds of a given technique contain what summing different powers costs, too") {
    const auto run = support::result_of(
        "run @interior --rays 3000 --disc-radius 2% --technique box-tree --fan-out 8 --leaf 8 --threads 1 "
        "--calibration none");
    Counts<double> counts;
    for (const auto& [name, term] : count_terms<double>)
      if (run["predicted"].contains(name)) counts.*term = run["predicted"][std::string(name)];
    const CostTable costs = validate::built_in_unit_costs();
    const double with_sums = price(counts, validate::costs_of_sums(costs), Technique::box_tree).total();
    CHECK(run["predicted_seconds"] == doctest::Approx(with_sums));
    CHECK(with_sums > 1.01 * price(counts, costs, Technique::box_tree).total());
  }
}

namespace detp::support {
namespace {

/// Pages that a command touched for the first time.
double pages_of(const std::string& line) {
  rusage before{};
  getrusage(RUSAGE_CHILDREN, &before);
  REQUIRE(detp(line).code == 0);
  rusage after{};
  getrusage(RUSAGE_CHILDREN, &after);
  return static_cast<double>(after.ru_minflt - before.ru_minflt);
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("a repeated search touches no memory for the first time, and has the arrays of the search before" *
            doctest::test_suite("long")) {
    if (sanitized) return;  // a sanitizer keeps freed memory apart
    for (const char* how : {"--technique box-tree --fan-out 4 --leaf 16", "--technique sphere-cache --ratio 0.6",
                            "--technique octree --depth 6", "--technique grid --cells 40"}) {
      CAPTURE(how);
      const std::string line = fmt::format("run @cornell --rays 60000 {} --quiet --repeat ", how);
      double few = 0;
      CHECK(in_attempts(3, [&] {  // the system may split a few large pages of 512 meanwhile
        few = pages_of(line + "3");
        return (pages_of(line + "103") - few) / 100 <= 20;
      }));
      CHECK(pages_of(line + "3 --memory-limit 1G") > few);  // with a limit, memory goes back at once
    }
  }
}

}  // namespace detp::support
