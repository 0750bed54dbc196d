#include <detp.h>
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <detp/detp.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

namespace {

/// Discs and rays in a caller's structs of floats.
struct Data {
  struct Sample {
    float position[3], normal[3], other;
  };
  struct Segment {
    float origin[3], direction[3], length, power;
  };
  std::vector<Sample> samples;
  std::vector<Segment> segments;

  Data(std::size_t discs, std::size_t rays, std::uint64_t seed) : samples(discs), segments(rays) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> number(-1, 1);
    for (Sample& s : samples)
      s = {{number(random), number(random), number(random)}, {number(random), number(random), 1}, 0};
    for (Segment& s : segments)
      s = {{number(random), number(random), number(random)}, {number(random), number(random), -1}, 2, 0.5F};
  }

  [[nodiscard]] detp_discs discs(double radius) const {
    detp_discs all = DETP_INIT(detp_discs);
    all.count = samples.size();
    all.centres = {samples[0].position, nullptr, nullptr, sizeof(Sample), DETP_FLOAT};
    all.normals = {samples[0].normal, nullptr, nullptr, sizeof(Sample), DETP_FLOAT};
    all.radii.of_all = radius;
    return all;
  }

  [[nodiscard]] detp_rays rays() const {
    detp_rays all = DETP_INIT(detp_rays);
    all.count = segments.size();
    all.origins = {segments[0].origin, nullptr, nullptr, sizeof(Segment), DETP_FLOAT};
    all.directions = {segments[0].direction, nullptr, nullptr, sizeof(Segment), DETP_FLOAT};
    all.lengths = {&segments[0].length, sizeof(Segment), DETP_FLOAT, 0};
    all.powers = {&segments[0].power, sizeof(Segment), DETP_FLOAT, 0};
    return all;
  }
};

/// What a search found, in arrays of its own.
struct Arrays {
  std::vector<std::uint64_t> hits;
  std::vector<double> irradiance, standard_error, upper_bound;
  detp_found found = DETP_INIT(detp_found);

  explicit Arrays(std::size_t discs) : hits(discs), irradiance(discs), standard_error(discs), upper_bound(discs) {
    found.hits = hits.data();
    found.irradiance = irradiance.data();
    found.standard_error = standard_error.data();
    found.upper_bound = upper_bound.data();
  }
};

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace

TEST_SUITE("c interface") {
  TEST_CASE("C and C++ choose the same and find the same bytes") {
    using namespace detp;
    const Data data(2000, 5000, 1);
    const detp_discs discs = data.discs(0.05);
    const detp_rays rays = data.rays();
    detp_plan* plan = nullptr;
    detp_scratch* scratch = nullptr;
    detp_error error{};
    REQUIRE(detp_plan_create(&discs, &rays, nullptr, &plan, &error) == DETP_OK);
    REQUIRE(detp_scratch_create(&scratch, &error) == DETP_OK);
    detp_plan_facts facts = DETP_INIT(detp_plan_facts);
    REQUIRE(detp_plan_describe(plan, &facts, &error) == DETP_OK);

    using Sample = Data::Sample;
    using Segment = Data::Segment;
    const sim::DiscsView discs_view{
        2000, {data.samples[0].position, sizeof(Sample)}, {data.samples[0].normal, sizeof(Sample)}, 0.05};
    const sim::RaysView rays_view{5000,
                                  {data.segments[0].origin, sizeof(Segment)},
                                  {data.segments[0].direction, sizeof(Segment)},
                                  {&data.segments[0].length, sizeof(Segment)},
                                  {&data.segments[0].power, sizeof(Segment)}};
    validate::Plan expected = validate::plan(discs_view, rays_view, {.threads = 0});
    CHECK(facts.technique == std::string(name(expected.candidate().technique)));
    CHECK(facts.discs == 2000);
    CHECK(facts.predicted_seconds > 0);
    sim::SearchScratch memory;
    for (const double radius : {0.05, 0.03}) {
      if (radius != 0.05) {
        detp_plan* smaller = nullptr;
        REQUIRE(detp_plan_with_radius(plan, radius, 0, &smaller, &error) == DETP_OK);
        detp_plan_free(&plan);
        plan = smaller;
        expected = validate::replan(expected, radius);
      }
      Arrays arrays(2000);
      detp_search_options options = DETP_INIT(detp_search_options);
      options.pairs = 1;
      options.threads = 1;
      REQUIRE(detp_search(plan, &rays, scratch, &options, &arrays.found, &error) == DETP_OK);
      const sim::Outcome& outcome =
          validate::execute(expected, rays_view, memory, {.pairs = true, .standard_error = true});
      CHECK(arrays.found.total_hits == outcome.total_hits);
      CHECK(same_bytes(arrays.hits, outcome.hits));
      CHECK(same_bytes(arrays.irradiance, outcome.irradiance));
      CHECK(same_bytes(arrays.standard_error, outcome.standard_error));
      CHECK(same_bytes(arrays.upper_bound, outcome.upper_bound));
      std::vector<std::uint64_t> offsets(2001);
      std::vector<std::uint32_t> hit_rays(outcome.pairs.size());
      REQUIRE(detp_pairs(scratch, offsets.data(), hit_rays.data(), hit_rays.size(), &error) == DETP_OK);
      std::vector<sim::Pair> pairs;
      for (std::uint32_t disc = 0; disc < 2000; ++disc)
        for (std::uint64_t i = offsets[disc]; i < offsets[disc + 1]; ++i) pairs.push_back({hit_rays[i], disc});
      std::ranges::sort(pairs);
      CHECK(pairs == outcome.pairs);
      CHECK(detp_pairs(scratch, offsets.data(), hit_rays.data(), hit_rays.size() - 1, &error) == DETP_INVALID);
      CHECK(std::string(error.text).find("capacity") != std::string::npos);
    }
    detp_plan_free(&plan);
    detp_scratch_free(&scratch);
    CHECK(plan == nullptr);
    detp_plan_free(&plan);  // does nothing
  }

  TEST_CASE("what is wrong is refused with its name, and nothing is made") {
    const Data data(10, 20, 1);
    detp_discs discs = data.discs(0.5);
    detp_rays rays = data.rays();
    detp_plan* plan = nullptr;
    detp_error error{};
    const auto refused = [&](const std::string& part) {
      CHECK(detp_plan_create(&discs, &rays, nullptr, &plan, &error) == DETP_INVALID);
      CHECK_MESSAGE(std::string(error.text).find(part) != std::string::npos, error.text, " has no ", part);
      CHECK(plan == nullptr);
      CHECK(detp_plan_create(&discs, &rays, nullptr, &plan, nullptr) == DETP_INVALID);
      discs = data.discs(0.5);
      rays = data.rays();
    };
    discs.size = 0;
    refused("discs: size");
    rays.origins.x = nullptr;
    refused("rays.origins: x is null");
    discs.normals.y = discs.normals.x;
    refused("discs.normals: y and z");
    rays.directions.type = 7;
    refused("rays.directions: type");
    discs.radii.of_all = -1;
    refused("radius");
    discs.radii.of_all = std::nan("");
    refused("radius");
    rays.count = 0;
    refused("ray");
    std::vector<Data::Segment> bad = data.segments;
    bad[17].direction[0] = bad[17].direction[1] = bad[17].direction[2] = 0;
    rays.directions.x = bad[0].direction;
    refused("ray 17");
    CHECK(detp_plan_create(&discs, nullptr, nullptr, &plan, &error) == DETP_INVALID);
    CHECK(std::string(error.text) == "rays is null");
    CHECK(detp_plan_create(&discs, &rays, nullptr, nullptr, &error) == DETP_INVALID);
    detp_plan_facts facts = DETP_INIT(detp_plan_facts);
    CHECK(detp_plan_describe(nullptr, &facts, &error) == DETP_INVALID);
    CHECK(std::string(error.text) == "plan is null");
  }

  TEST_CASE("a progress function is called, and stops the work") {
    const Data data(5000, 50000, 1);
    const detp_discs discs = data.discs(0.05);
    const detp_rays rays = data.rays();
    detp_plan_options options = DETP_INIT(detp_plan_options);
    int calls = 0;
    options.user = &calls;
    options.progress = [](void* user, const char* what, double share) {
      CHECK(what != nullptr);
      CHECK((share >= 0 && share <= 1));
      ++*static_cast<int*>(user);
      return 0;
    };
    detp_plan* plan = nullptr;
    detp_error error{};
    REQUIRE(detp_plan_create(&discs, &rays, &options, &plan, &error) == DETP_OK);
    CHECK(calls > 0);
    detp_scratch* scratch = nullptr;
    REQUIRE(detp_scratch_create(&scratch, &error) == DETP_OK);
    detp_search_options stopping = DETP_INIT(detp_search_options);
    stopping.progress = [](void*, const char*, double) { return 1; };
    Arrays arrays(5000);
    CHECK(detp_search(plan, &rays, scratch, &stopping, &arrays.found, &error) == DETP_STOPPED);
    CHECK(arrays.found.stopped == 1);
    std::vector<std::uint64_t> offsets(5001);
    CHECK(detp_pairs(scratch, offsets.data(), nullptr, 0, &error) == DETP_INVALID);
    detp_plan_free(&plan);
    options.progress = stopping.progress;
    CHECK(detp_plan_create(&discs, &rays, &options, &plan, &error) == DETP_STOPPED);
    CHECK(plan == nullptr);
    detp_scratch_free(&scratch);
  }

  TEST_CASE("numbers alone are enough to choose; a newer caller's struct is taken as far as it is known") {
    detp_workload workload = DETP_INIT(detp_workload);
    workload.rays = 1e5;
    workload.samples = 1e4;
    workload.disc_radius = 0.02;
    workload.scene_side = 2;
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

  TEST_CASE("a search until an error ends there, says so, and agrees with one long search") {
    struct Lamp {
      std::vector<Data::Segment> segments;
      std::uint64_t seed = 0;
      std::uint64_t rays = 0;
      std::uint64_t most = 1'000'000'000;
    } lamp;
    const Data data(500, 1000, 3);
    const detp_discs discs = data.discs(0.2);
    const detp_rays first = data.rays();
    detp_plan* plan = nullptr;
    detp_error error{};
    REQUIRE(detp_plan_create(&discs, &first, nullptr, &plan, &error) == DETP_OK);
    const auto next = [](void* user, std::uint64_t wanted, detp_rays* rays, double*, double* scale) {
      Lamp& one = *static_cast<Lamp*>(user);
      if (one.rays >= one.most) return 1;
      Data made(1, wanted, 1000 + ++one.seed);
      one.segments = std::move(made.segments);
      one.rays += wanted;
      *rays = DETP_INIT(detp_rays);
      rays->count = wanted;
      rays->origins = {one.segments[0].origin, nullptr, nullptr, sizeof(Data::Segment), DETP_FLOAT};
      rays->directions = {one.segments[0].direction, nullptr, nullptr, sizeof(Data::Segment), DETP_FLOAT};
      rays->lengths.of_all = 2;
      *scale = 1 / static_cast<double>(wanted);  // all photons have the power 1
      return 0;
    };
    detp_target target = DETP_INIT(detp_target);
    target.noise = 0.05;
    std::vector<double> irradiance(500);
    detp_estimate estimate = DETP_INIT(detp_estimate);
    estimate.irradiance = irradiance.data();
    REQUIRE_MESSAGE(detp_search_until(plan, next, &lamp, &target, nullptr, nullptr, &estimate, &error) == DETP_OK,
                    error.text);
    CHECK(estimate.reason == DETP_REACHED);
    CHECK(estimate.noise < 0.05);
    CHECK(estimate.noise_high <= 0.05 * 1.0001);
    CHECK(estimate.rays == lamp.rays);
    // A hundred times as many photons: the distance is that of the noise.
    Lamp bright;
    bright.seed = 500;
    std::vector<double> expected(500);
    detp_target closer = target;
    closer.noise = 0.008;
    detp_estimate best = DETP_INIT(detp_estimate);
    best.irradiance = expected.data();
    REQUIRE(detp_search_until(plan, next, &bright, &closer, nullptr, nullptr, &best, &error) == DETP_OK);
    double difference = 0;
    double square = 0;
    for (std::size_t i = 0; i < 500; ++i) {
      difference += (irradiance[i] - expected[i]) * (irradiance[i] - expected[i]);
      square += expected[i] * expected[i];
    }
    CHECK(std::sqrt(difference / square) < 0.06);
    CHECK(std::sqrt(difference / square) > 0.01);
    Lamp few;
    few.most = 1;
    REQUIRE(detp_search_until(plan, next, &few, &closer, nullptr, nullptr, &best, &error) == DETP_OK);
    CHECK(best.reason == DETP_NO_MORE_RAYS);
    target.noise = 2;
    CHECK(detp_search_until(plan, next, &lamp, &target, nullptr, nullptr, &estimate, &error) == DETP_INVALID);
    CHECK(detp_search_until(plan, nullptr, &lamp, &closer, nullptr, nullptr, &estimate, &error) == DETP_INVALID);
    const auto stop = [](void*, const char*, double) { return 1; };
    CHECK(detp_search_until(plan, next, &lamp, &closer, stop, nullptr, &estimate, &error) == DETP_STOPPED);
    detp_plan_free(&plan);
  }

  TEST_CASE("every question of the command can be asked, and is answered as JSON") {
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
      switch (random() % 9) {
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
