#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "callers_data.hpp"

using detp::support::Arrays;
using detp::support::Data;

TEST_SUITE("c interface") {
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
