#include <detp.h>
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "callers_data.hpp"

using detp::support::Arrays;
using detp::support::Data;

namespace {

detp_workload samples_in_a_cube() {
  detp_workload workload = DETP_INIT(detp_workload);
  workload.rays = 1e5;
  workload.samples = 1e4;
  workload.disc_radius = 0.02;
  workload.scene_side = 2;
  return workload;
}

}  // namespace

TEST_SUITE("c interface") {
  TEST_CASE("numbers alone are enough to choose; a newer caller's struct is taken as far as it is known") {
    detp_workload workload = samples_in_a_cube();
    char text[200];
    detp_error error{};
    detp_plan_facts facts = DETP_INIT(detp_plan_facts);
    REQUIRE(detp_choose(&workload, nullptr, 1, text, sizeof(text), &facts, &error) == DETP_OK);
    CHECK(facts.predicted_seconds > 0);
    CHECK(facts.technique == text);
    CHECK(facts.parameters[0] == '{');
    CHECK(facts.threads == 1);
    struct {
      detp_workload known;
      double more;
    } newer{workload, 0};
    newer.known.size = sizeof(newer);
    CHECK(detp_choose(&newer.known, nullptr, 1, text, sizeof(text), &facts, &error) == DETP_OK);
    newer.more = 1;
    CHECK(detp_choose(&newer.known, nullptr, 1, text, sizeof(text), &facts, &error) == DETP_INVALID);
    CHECK(std::string(error.text).find("does not know") != std::string::npos);
    CHECK(detp_choose(&workload, nullptr, 1, text, 5, &facts, &error) == DETP_INVALID);
    workload.disc_radius = 0;
    CHECK(detp_choose(&workload, nullptr, 1, text, sizeof(text), &facts, &error) == DETP_INVALID);
    detp_costs* costs = nullptr;
    REQUIRE(detp_costs_built_in(&costs, &error) == DETP_OK);
    detp_costs_free(&costs);
    CHECK(costs == nullptr);
    CHECK(detp_costs_measured(-1, 0, nullptr, nullptr, &costs, &error) == DETP_INVALID);
    CHECK(std::string(detp_version()) != "");
  }

  TEST_CASE("closed forms are those of the command, published and corrected; best parameters are filled in") {
    detp_workload workload = samples_in_a_cube();
    char text[200];
    detp_error error{};
    std::vector<detp_sphere> spheres(64);
    for (const bool published : {false, true}) {
      detp_prediction found = DETP_INIT(detp_prediction);
      found.spheres = spheres.data();
      found.room = spheres.size();
      REQUIRE_MESSAGE(detp_predict(&workload, "sphere-cache", R"({"ratio":0.65,"spheres":8})", published ? 1 : 0,
                                   nullptr, 1, text, sizeof(text), &found, &error) == DETP_OK,
                      error.text);
      const char* const words[] = {"model",   "--samples",    "10000",
                                   "--rays",  "100000",       "--disc-radius",
                                   "0.02",    "--scene-side", "2",
                                   "--ratio", "0.65",         "--spheres",
                                   "8",       "--form",       published ? "published" : "corrected"};
      char* json = nullptr;
      REQUIRE(detp_ask(words, std::size(words), nullptr, nullptr, &json, &error) == DETP_OK);
      const nlohmann::json expected = nlohmann::json::parse(json);
      detp_text_free(&json);
      CHECK(nlohmann::json::parse(text)["spheres"] == 8);
      CHECK(found.k == 8);
      CHECK(found.counts.disc_tests == expected["counts"]["disc_tests"].get<double>());
      CHECK(found.counts.cull_tests == expected["counts"]["cull_tests"].get<double>());
      CHECK(found.counts.hits == expected["counts"]["hits"].get<double>());
      CHECK(found.rebuild_seconds > 0);
      CHECK(found.intersect_seconds > 0);
      CHECK(found.seconds >= found.rebuild_seconds + found.intersect_seconds);
      for (std::size_t i = 0; i < 8; ++i) {
        const nlohmann::json& level = expected["spheres"][i];
        CHECK(spheres[i].radius == level["radius"].get<double>());
        CHECK(spheres[i].rays == level["rays"].get<double>());
        CHECK(spheres[i].rebuilds == level["rebuilds"].get<double>());
        CHECK(spheres[i].rebuild_cost == level["rebuild_cost"].get<double>());
      }
    }
    detp_prediction best = DETP_INIT(detp_prediction);
    detp_prediction with_ratio = DETP_INIT(detp_prediction);
    REQUIRE(detp_predict(&workload, "sphere-cache", nullptr, 0, nullptr, 1, text, sizeof(text), &best, &error) ==
            DETP_OK);
    CHECK(nlohmann::json::parse(text).contains("ratio"));
    REQUIRE(detp_predict(&workload, "sphere-cache", R"({"ratio":0.3})", 0, nullptr, 1, text, sizeof(text), &with_ratio,
                         &error) == DETP_OK);
    CHECK(nlohmann::json::parse(text)["ratio"] == 0.3);
    CHECK(best.seconds < with_ratio.seconds);
    detp_plan_facts facts = DETP_INIT(detp_plan_facts);
    REQUIRE(detp_choose(&workload, nullptr, 1, text, sizeof(text), &facts, &error) == DETP_OK);
    const std::string parameters = facts.parameters;
    const std::string technique = facts.technique;
    REQUIRE(detp_predict(&workload, technique.c_str(), parameters.c_str(), 0, nullptr, 1, text, sizeof(text), &best,
                         &error) == DETP_OK);
    CHECK(text == parameters);
    CHECK(best.seconds == facts.predicted_seconds);
    const auto refused = [&](const char* name, const char* given, int published, const std::string& part) {
      CHECK(detp_predict(&workload, name, given, published, nullptr, 1, text, sizeof(text), &best, &error) ==
            DETP_INVALID);
      CHECK_MESSAGE(std::string(error.text).find(part) != std::string::npos, error.text, " has no ", part);
    };
    refused(nullptr, nullptr, 0, "technique is null");
    refused("sphere-cash", nullptr, 0, "sphere-cash");
    refused("sphere-cache", "{", 0, "JSON");
    refused("sphere-cache", R"({"depth":3})", 0, "no parameter");
    refused("sphere-cache", R"({"ratio":1.5})", 0, "ratio");
    refused("octree", nullptr, 1, "published");
    refused("sphere-cache", nullptr, 1, "ratio");
    refused("bsp", nullptr, 0, "closed form");
  }

  TEST_CASE("a run finds in memory what the command prints") {
    const char* const words[] = {"@cornell", "--rays", "5000", "--technique", "grid", "--standard-error"};
    detp_run* run = nullptr;
    detp_error error{};
    REQUIRE_MESSAGE(detp_run_create(words, std::size(words), nullptr, nullptr, &run, &error) == DETP_OK, error.text);
    detp_run_view view = DETP_INIT(detp_run_view);
    REQUIRE(detp_run_look(run, &view, &error) == DETP_OK);
    const nlohmann::json answer = nlohmann::json::parse(view.json);
    REQUIRE(view.discs == answer["inputs"]["samples"]);
    CHECK(std::accumulate(view.hits, view.hits + view.discs, std::uint64_t{0}) == answer["hits"]);
    const double sum = std::accumulate(view.irradiance, view.irradiance + view.discs, 0.0);
    CHECK(sum / static_cast<double>(view.discs) == answer["mean_irradiance"]);
    CHECK(view.radii[0] == answer["inputs"]["disc_radius"]);
    CHECK(view.upper_bound[0] >= view.irradiance[0]);
    CHECK(std::abs(std::hypot(view.normals[0], view.normals[1], view.normals[2]) - 1) < 1e-12);
    detp_run_free(&run);
    CHECK(run == nullptr);
    const char* const rgb[] = {"@cornell", "--rays", "5000", "--samples", "50", "--bands", "rgb"};
    REQUIRE_MESSAGE(detp_run_create(rgb, std::size(rgb), nullptr, nullptr, &run, &error) == DETP_OK, error.text);
    REQUIRE(detp_run_look(run, &view, &error) == DETP_OK);
    REQUIRE(view.bands == 3);
    double blue = 0;
    for (std::size_t disc = 0; disc < view.discs; ++disc) blue += view.irradiance[3 * disc + 2];
    CHECK(blue / static_cast<double>(view.discs) == nlohmann::json::parse(view.json)["mean_irradiance"]["b"]);
    detp_run_free(&run);
    const char* const rows[] = {"@cornell", "--rays", "1000,2000"};
    CHECK(detp_run_create(rows, std::size(rows), nullptr, nullptr, &run, &error) == DETP_INVALID);
    CHECK(detp_run_look(nullptr, &view, &error) == DETP_INVALID);
  }

  TEST_CASE("every question of the command can be asked, and is answered as JSON" * doctest::test_suite("long")) {
    const char* const words[] = {"model",         "--samples", "1000",         "--rays", "100",
                                 "--disc-radius", "0.02",      "--scene-side", "2"};
    char* json = nullptr;
    detp_error error{};
    REQUIRE(detp_ask(words, std::size(words), nullptr, nullptr, &json, &error) == DETP_OK);
    const nlohmann::json answer = nlohmann::json::parse(json);
    CHECK(answer["schema"]["name"] == "detp.model");
    CHECK(answer["k"].get<int>() > 0);
    detp_text_free(&json);
    CHECK(json == nullptr);
    const std::vector<std::pair<std::vector<const char*>, const char*>> questions{
        {{"run", "@cornell", "--rays", "1000"}, "hits"},
        {{"run", "@cornell", "--target-noise", "50%"}, "noise"},
        {{"accuracy", "@cornell", "--target-noise", "20%", "--effort", "quick"}, "answer"},
        {{"choose", "@cornell", "--rays", "1000"}, "choice"},
        {{"scene", "@cornell", "--rays", "1000"}, "effects"},
        {{"validate", "--experiments", "lines"}, "claims"}};
    for (const auto& one : questions) {
      const std::vector<const char*>& question = one.first;
      CAPTURE(question[0]);
      const detp_status status = detp_ask(question.data(), question.size(), nullptr, nullptr, &json, &error);
      REQUIRE_MESSAGE(status == DETP_OK, error.text);
      CHECK_MESSAGE(nlohmann::json::parse(json).contains(one.second), json);
      detp_text_free(&json);
    }
    const char* const bad[] = {"model", "--sample", "1000"};
    CHECK(detp_ask(bad, std::size(bad), nullptr, nullptr, &json, &error) == DETP_INVALID);
    CHECK(std::string(error.text).find("--sample") != std::string::npos);
    CHECK(detp_ask(nullptr, 1, nullptr, nullptr, &json, &error) == DETP_INVALID);
    const char* const missing[] = {"run", "/nowhere/scene.obj"};
    CHECK(detp_ask(missing, 2, nullptr, nullptr, &json, &error) == DETP_FILE);
    const char* const help[] = {"--help"};
    CHECK(detp_ask(help, 1, nullptr, nullptr, &json, &error) == DETP_INVALID);
    const char* const long_work[] = {"validate", "--seed", "1"};
    const auto stop = [](void*, const char*, double) { return 1; };
    const detp_status stopped = detp_ask(long_work, 3, stop, nullptr, &json, &error);
    if (stopped == DETP_OK) CHECK(nlohmann::json::parse(json)["stopped"] == true);
    CHECK((stopped == DETP_OK || stopped == DETP_STOPPED));
    detp_text_free(&json);
  }

  TEST_CASE("calls in any order, with good and bad arguments, end with a status") {
    const char* const wanted = std::getenv("DETP_CALLS");
    const int calls = wanted != nullptr ? std::atoi(wanted) : 2000;
    std::mt19937_64 random(1);
    const Data data(40, 60, 2);
    std::vector<detp_plan*> plans(3, nullptr);
    std::vector<detp_scratch*> scratches(2, nullptr);
    detp_costs* costs = nullptr;
    std::vector<std::uint64_t> offsets(41);
    std::vector<std::uint32_t> hit_rays(4000);
    const auto one_of = [&](auto& all) -> auto& { return all[random() % all.size()]; };
    const auto number = [&] {
      static const std::vector<double> numbers{
          0, 1, 0.3, -1, 1e300, std::nan(""), 1e-320, std::numeric_limits<double>::infinity()};
      return random() % 2 == 0 ? 0.3 : numbers[random() % numbers.size()];
    };
    int fine = 0;
    for (int i = 0; i < calls; ++i) {
      detp_error error{};
      detp_discs discs = data.discs(number());
      detp_rays rays = data.rays();
      rays.count = 1 + random() % rays.count;
      if (random() % 8 == 0) rays.lengths = {nullptr, 0, DETP_DOUBLE, number()};
      if (random() % 16 == 0) discs.size = random() % sizeof(detp_discs);
      if (random() % 16 == 0) rays.origins.x = nullptr;
      detp_plan_options options = DETP_INIT(detp_plan_options);
      options.threads = static_cast<int>(random() % 4) - 1;
      options.once = static_cast<int>(random() % 2);
      options.costs = costs;
      if (random() % 8 == 0) options.rays = number();
      if (random() % 8 == 0) options.farthest = number();
      Arrays arrays(40);
      if (random() % 4 == 0) arrays.found.hits = nullptr;
      detp_search_options search = DETP_INIT(detp_search_options);
      search.pairs = static_cast<int>(random() % 2);
      search.threads = static_cast<int>(random() % 3);
      detp_plan_facts facts = DETP_INIT(detp_plan_facts);
      detp_status status = DETP_OK;
      switch (random() % 10) {
        case 0: {
          detp_plan*& plan = one_of(plans);
          detp_plan_free(&plan);
          status = detp_plan_create(&discs, &rays, random() % 4 == 0 ? nullptr : &options, &plan, &error);
          break;
        }
        case 1: {
          detp_plan* changed = nullptr;
          status = detp_plan_with_radius(one_of(plans), number(), random() % 4 == 0 ? number() : 0, &changed, &error);
          if (status == DETP_OK) std::swap(one_of(plans), changed);
          detp_plan_free(&changed);
          break;
        }
        case 2:
        case 3:
          status = detp_search(one_of(plans), &rays, one_of(scratches), &search, &arrays.found, &error);
          break;
        case 4:
          status = detp_pairs(one_of(scratches), offsets.data(), hit_rays.data(), hit_rays.size(), &error);
          break;
        case 5: {
          detp_scratch*& scratch = one_of(scratches);
          detp_scratch_free(&scratch);
          status = detp_scratch_create(&scratch, &error);
          break;
        }
        case 6:
          status = detp_plan_describe(one_of(plans), &facts, &error);
          break;
        case 7:
          detp_costs_free(&costs);
          if (random() % 2 == 0) status = detp_costs_built_in(&costs, &error);
          break;
        case 8: {
          static const std::vector<const char*> techniques{"sphere-cache", "octree", "bvh", "none", nullptr};
          static const std::vector<const char*> parameters{nullptr, "{}", "{\"ratio\":0.5}", "{\"depth\":3}", "[", ""};
          detp_workload workload = DETP_INIT(detp_workload);
          workload.rays = 1000;
          workload.samples = 100;
          workload.disc_radius = number();
          workload.scene_side = 2;
          char text[200];
          detp_prediction prediction = DETP_INIT(detp_prediction);
          std::vector<detp_sphere> spheres(random() % 8);
          prediction.spheres = random() % 4 == 0 ? nullptr : spheres.data();
          prediction.room = spheres.size();
          status = detp_predict(&workload, techniques[random() % techniques.size()],
                                parameters[random() % parameters.size()], static_cast<int>(random() % 2), costs, 1,
                                text, random() % 200, &prediction, &error);
          break;
        }
        default:
          detp_plan_free(&one_of(plans));
      }
      CHECK(status != DETP_INTERNAL);
      CHECK((status == DETP_OK) == (error.text[0] == 0));
      fine += status == DETP_OK ? 1 : 0;
    }
    CHECK(fine > calls / 4);
    for (detp_plan*& plan : plans) detp_plan_free(&plan);
    for (detp_scratch*& scratch : scratches) detp_scratch_free(&scratch);
    detp_costs_free(&costs);
  }
}
