#include <detp.h>
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <detp/detp.hpp>
#include <limits>
#include <vector>

#include "callers_data.hpp"
#include "detp/sim/open/open_scene.hpp"

using detp::support::Arrays;
using detp::support::Data;
using detp::support::same_bytes;

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
      options.count = 1;
      REQUIRE(detp_search(plan, &rays, scratch, &options, &arrays.found, &error) == DETP_OK);
      const sim::Outcome& outcome =
          validate::execute(expected, rays_view, memory, {.pairs = true, .standard_error = true});
      CHECK(arrays.found.total_hits == outcome.total_hits);
      CHECK(arrays.found.counts.hits == static_cast<double>(outcome.total_hits));
      CHECK(arrays.found.counts.disc_tests == static_cast<double>(outcome.counts.disc_tests));
      CHECK(arrays.found.reading_seconds > 0);
      CHECK(arrays.found.seconds >= arrays.found.reading_seconds + arrays.found.build_seconds);
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

  TEST_CASE("powers in three bands bring the bytes of three searches, in rows") {
    Data data(500, 5000, 1);
    for (std::size_t i = 0; i < data.segments.size(); ++i) data.segments[i].power = static_cast<float>(i % 7);
    const detp_discs discs = data.discs(0.2);
    detp_rays rays = data.rays();
    detp_plan* plan = nullptr;
    detp_scratch* scratch = nullptr;
    detp_error error{};
    REQUIRE(detp_plan_create(&discs, &rays, nullptr, &plan, &error) == DETP_OK);
    REQUIRE(detp_scratch_create(&scratch, &error) == DETP_OK);
    std::vector<double> squares;
    for (std::size_t i = 0; i < 5000; ++i) squares.push_back(0.1 * static_cast<double>(i * i % 11));
    const detp_numbers own = rays.powers;
    const detp_numbers bands[3]{own, {squares.data(), 0, DETP_DOUBLE, 0}, {nullptr, 0, DETP_DOUBLE, 2.5}};
    std::vector<Arrays> each(3, Arrays(500));
    for (std::size_t band = 0; band < 3; ++band) {
      Arrays one(500);
      rays.powers = bands[band];
      REQUIRE(detp_search(plan, &rays, scratch, nullptr, &one.found, &error) == DETP_OK);
      each[band].irradiance = one.irradiance;
      each[band].upper_bound = one.upper_bound;
    }
    rays.powers = own;
    rays.further_powers = bands + 1;
    rays.further_bands = 2;
    Arrays all(1500);
    CHECK(detp_search(plan, &rays, scratch, nullptr, &all.found, &error) == DETP_INVALID);
    CHECK(std::string(error.text) == "found.bands is 0, but the rays have 3");
    all.found.bands = 3;
    REQUIRE(detp_search(plan, &rays, scratch, nullptr, &all.found, &error) == DETP_OK);
    for (std::size_t disc = 0; disc < 500; ++disc)
      for (std::size_t band = 0; band < 3; ++band) {
        REQUIRE(all.irradiance[3 * disc + band] == each[band].irradiance[disc]);
        REQUIRE(all.upper_bound[3 * disc + band] == each[band].upper_bound[disc]);
      }
    rays.further_bands = 64;
    CHECK(detp_search(plan, &rays, scratch, nullptr, &all.found, &error) == DETP_INVALID);
    CHECK(std::string(error.text) == "rays: there are 64 further bands; the maximum is 63");
    detp_plan_free(&plan);
    detp_scratch_free(&scratch);
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
    for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
      for (int axis = 0; axis < 3; ++axis) {
        bad = data.segments;
        bad[3].direction[0] = bad[3].direction[1] = bad[3].direction[2] = 0;
        bad[3].direction[axis] = wrong;
        rays.directions.x = bad[0].direction;
        refused(std::isnan(wrong) ? "ray 3: direction must be finite (got nan"
                                  : "ray 3: direction must be finite (got inf");
        std::vector<Data::Sample> samples = data.samples;
        samples[4].normal[0] = samples[4].normal[1] = samples[4].normal[2] = 0;
        samples[4].normal[axis] = wrong;
        discs.normals.x = samples[0].normal;
        refused("disc 4: normal must be finite");
      }
    for (const std::size_t count : {SIZE_MAX, std::size_t{1} << 44})
      for (std::size_t* const which : {&discs.count, &rays.count}) {
        *which = count;
        CHECK(detp_plan_create(&discs, &rays, nullptr, &plan, &error) == DETP_NO_MEMORY);
        CHECK(std::string(error.text).find("count must be at most 2^43") != std::string::npos);
        discs = data.discs(0.5);
        rays = data.rays();
      }
    discs.count = std::size_t{1} << 42;
    CHECK(detp_plan_create(&discs, &rays, nullptr, &plan, &error) == DETP_NO_MEMORY);
    CHECK_MESSAGE(std::string(error.text).find("the discs would take") != std::string::npos, error.text);
    discs = data.discs(0.5);
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

  TEST_CASE("paths in a scene: the irradiance that C++ finds, the light that they miss, refusals and stops") {
    using namespace detp;
    const double places[3][3] = {{0.5, 0, 0.5}, {0.3, 0, 0.6}, {0.6, 0, 0.4}};
    detp_discs samples = DETP_INIT(detp_discs);
    samples.count = 3;
    samples.centres = {places, nullptr, nullptr, 0, DETP_DOUBLE};
    const std::vector<double> zeros(3, 0);
    const std::vector<double> twos(3, 2);
    samples.normals = {zeros.data(), twos.data(), zeros.data(), 0, DETP_DOUBLE};
    std::vector<std::uint64_t> hits(3);
    std::vector<double> irradiance(3), errors(3), bounds(3);
    detp_gathered gathered = DETP_INIT(detp_gathered);
    gathered.hits = hits.data();
    gathered.irradiance = irradiance.data();
    gathered.standard_error = errors.data();
    gathered.upper_bound = bounds.data();
    detp_gather_options options = DETP_INIT(detp_gather_options);
    options.paths = 500;
    options.seed = 4;
    detp_error error{};
    REQUIRE(detp_gather("@furnace", &samples, &options, &gathered, &error) == DETP_OK);
    const sim::Scene furnace = sim::open_scene({.name = "@furnace", .samples = {}});
    std::vector<sim::Disc> discs;
    for (const auto& [x, y, z] : places) discs.push_back({{x, y, z}, {0, 1, 0}, 1});
    const sim::Outcome expected = sim::estimate(
        sim::make_problem_without_rays(discs, 0),
        {.estimator = sim::Estimator::gather, .scene = &furnace, .paths = 500, .seed = 4}, {.standard_error = true});
    CHECK(same_bytes(irradiance, expected.irradiance));
    CHECK(same_bytes(errors, expected.standard_error));
    CHECK(same_bytes(bounds, expected.upper_bound));
    CHECK(hits == expected.hits);
    CHECK(std::abs(irradiance[0] - *furnace.known_irradiance) < 4 * errors[0]);
    CHECK(gathered.missed_bound == 0);
    CHECK(gathered.seconds > 0);
    std::vector<double> rows(3 * discs.size());  // of a grey scene: alike
    detp_gathered in_colours = DETP_INIT(detp_gathered);
    in_colours.irradiance = rows.data();
    options.rgb = 1;
    REQUIRE(detp_gather("@furnace", &samples, &options, &in_colours, &error) == DETP_OK);
    for (std::size_t i = 0; i < rows.size(); ++i) CHECK(rows[i] == doctest::Approx(irradiance[i / 3]).epsilon(1e-12));
    options.rgb = 0;
    REQUIRE(detp_gather("@caustic", &samples, nullptr, &gathered, &error) == DETP_OK);
    CHECK(gathered.missed_share > 0.01);
    CHECK(gathered.missed_bound > gathered.missed_share);

    const auto refused = [&](detp_status status, const char* why) {
      CAPTURE(error.text);
      CHECK(status != DETP_OK);
      CHECK(std::strstr(error.text, why) != nullptr);
    };
    refused(detp_gather(nullptr, &samples, nullptr, &gathered, &error), "scene is null");
    refused(detp_gather("@furnace", nullptr, nullptr, &gathered, &error), "discs");
    refused(detp_gather("@furnace", &samples, nullptr, nullptr, &error), "gathered");
    refused(detp_gather("@uniform", &samples, nullptr, &gathered, &error), "triangles");
    refused(detp_gather("none.obj", &samples, nullptr, &gathered, &error), "none.obj");
    options.paths = std::uint64_t{1} << 40;
    refused(detp_gather("@furnace", &samples, &options, &gathered, &error), "paths");
    options.paths = 1U << 30;
    options.progress = [](void*, const char*, double share) { return share >= 0 ? 1 : 0; };
    CHECK(detp_gather("@furnace", &samples, &options, &gathered, &error) == DETP_STOPPED);
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
    // In two bands, of which the second is twice the first: each as in a search of it alone.
    struct TwoBands {
      Lamp lamp;
      std::vector<double> powers;
      detp_numbers further{};
    } two;
    const auto next_of_two = [](void* user, std::uint64_t wanted, detp_rays* rays, double* photons, double* scale) {
      TwoBands& one = *static_cast<TwoBands*>(user);
      const int answer = decltype(next){}(&one.lamp, wanted, rays, photons, scale);
      one.powers.assign(wanted, 2);
      one.further = {one.powers.data(), sizeof(double), DETP_DOUBLE, 0};
      rays->further_powers = &one.further;
      rays->further_bands = 1;
      return answer;
    };
    std::vector<double> rows(1000);
    detp_estimate in_bands = DETP_INIT(detp_estimate);
    in_bands.irradiance = rows.data();
    in_bands.bands = 2;
    detp_target of_second = target;
    of_second.noise_of = 2;
    REQUIRE(detp_search_until(plan, next_of_two, &two, &of_second, nullptr, nullptr, &in_bands, &error) == DETP_OK);
    CHECK(in_bands.noise == estimate.noise);
    CHECK(in_bands.rays == estimate.rays);
    for (std::size_t i = 0; i < 500; ++i) {
      REQUIRE(rows[2 * i] == irradiance[i]);
      REQUIRE(rows[2 * i + 1] == 2 * irradiance[i]);
    }
    of_second.noise_of = 3;
    CHECK(detp_search_until(plan, next_of_two, &two, &of_second, nullptr, nullptr, &in_bands, &error) == DETP_INVALID);
    CHECK(detp_search_until(plan, next, &lamp, &closer, nullptr, nullptr, &in_bands, &error) == DETP_INVALID);
    target.noise = 2;
    CHECK(detp_search_until(plan, next, &lamp, &target, nullptr, nullptr, &estimate, &error) == DETP_INVALID);
    CHECK(detp_search_until(plan, nullptr, &lamp, &closer, nullptr, nullptr, &estimate, &error) == DETP_INVALID);
    const auto stop = [](void*, const char*, double) { return 1; };
    CHECK(detp_search_until(plan, next, &lamp, &closer, stop, nullptr, &estimate, &error) == DETP_STOPPED);
    detp_plan_free(&plan);
  }

  TEST_CASE("numbers that the caller's function returns are checked") {
    const Data data(500, 1000, 3);
    const detp_discs discs = data.discs(0.2);
    const detp_rays first = data.rays();
    detp_plan* plan = nullptr;
    detp_error error{};
    REQUIRE(detp_plan_create(&discs, &first, nullptr, &plan, &error) == DETP_OK);
    struct Answer {
      detp_rays rays;
      double photons = 0, scale = 1;
    };
    const auto next = [](void* user, std::uint64_t, detp_rays* rays, double* photons, double* scale) {
      const Answer& answer = *static_cast<Answer*>(user);
      *rays = answer.rays;
      *photons = answer.photons;
      *scale = answer.scale;
      return 0;
    };
    detp_target target = DETP_INIT(detp_target);
    target.noise = 0.05;
    target.most_rays = 10'000;
    std::vector<double> irradiance(500, -7);
    detp_estimate estimate = DETP_INIT(detp_estimate);
    estimate.irradiance = irradiance.data();
    const auto refused = [&](Answer answer, const std::string& part) {
      CHECK(detp_search_until(plan, next, &answer, &target, nullptr, nullptr, &estimate, &error) == DETP_INVALID);
      CHECK_MESSAGE(std::string(error.text).find(part) != std::string::npos, error.text, " has no ", part);
      CHECK(irradiance == std::vector<double>(500, -7));
      CHECK(estimate.rays == 0);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double wrong : {-1.0, 0.0, nan, infinite, -infinite}) {
      refused({.rays = first, .scale = wrong}, "scale of a batch must be > 0 and finite");
      if (wrong != 0) refused({.rays = first, .photons = wrong}, "number of photons must be >= 0 and finite");
    }
    refused({.rays = first, .scale = 1e308}, "irradiance of a batch must be finite");
    std::vector<std::uint64_t> numbers(first.count);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i / 2;
    detp_rays numbered = first;
    numbered.photons = numbers.data();
    refused({.rays = numbered, .photons = 499}, "rays of 500 photons, more than its 499");
    detp_rays none = DETP_INIT(detp_rays);
    refused({.rays = none}, "there are none, and no photons");
    const Answer good{.rays = numbered, .photons = 500};
    for (const double wrong : {nan, -4.0, infinite}) {
      target.most_rays = wrong;
      refused(good, "most rays must be > 0 and finite");
    }
    target.most_rays = 10'000;
    Answer answer = good;
    CHECK_MESSAGE(detp_search_until(plan, next, &answer, &target, nullptr, nullptr, &estimate, &error) == DETP_OK,
                  error.text);
    detp_plan_free(&plan);
  }

  TEST_CASE("questions of the command alone are refused with a word of why") {
    const auto refused = [](std::vector<const char*> words, const std::string& part) {
      char* json = nullptr;
      detp_error error{};
      CHECK(detp_ask(words.data(), words.size(), nullptr, nullptr, &json, &error) == DETP_INVALID);
      CHECK_MESSAGE(std::string(error.text).find(part) != std::string::npos, error.text, " has no ", part);
      CHECK(json == nullptr);
    };
    for (const char* word : {"--help", "-h", "--version", "-V"}) refused({word}, "for the command alone");
    refused({"help", "run"}, "for the command alone");
    refused({"run", "--help"}, "for the command alone");
    refused({}, "a command is needed");
    refused({"model", "--samples", "10", "--disc-radius", "0.1", "--scene-side", "1", "-o", "x.json"},
            "--output is for the command alone");
  }
}
