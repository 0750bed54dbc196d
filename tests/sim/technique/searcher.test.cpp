#include "detp/sim/technique/searcher.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/allocations.hpp"
#include "support/candidates.hpp"
#include "support/machine.hpp"

using namespace detp;
using namespace detp::sim;
using support::allocations;

namespace {

const std::vector<Disc>& searched_discs() {
  static const std::vector<Disc> all = uniform_discs(Body::cube, 2, 700, 0.2, 3);
  return all;
}

/// Lines and segments of different powers.
std::vector<Ray> rays_of(std::uint64_t seed, std::size_t count) {
  std::vector<Ray> rays = LineField(enclosing_sphere(searched_discs()), seed).lines(0, count);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto random = uniform4(seed, Stream::tests, i);
    rays[i].power = random[0];
    if (i % 3 == 0) rays[i].length = 0.1 + 2 * random[1];
  }
  return rays;
}

/// The exact variants, and the walk as it was published.
std::vector<Candidate> candidates() {
  std::vector<Candidate> all = support::exact_candidates();
  all.push_back({Technique::sphere_cache_published, SphereCacheParameters{0.6, 4}});
  return all;
}

bool same(const Outcome& a, const Outcome& b) {
  return a.hits == b.hits && a.irradiance == b.irradiance && a.total_hits == b.total_hits;
}

}  // namespace

TEST_SUITE("searcher") {
  TEST_CASE("Searched again and again with one scratch, every technique and engine finds what a run finds") {
    for (const Engine engine : {Engine::simd, Engine::plain})
      for (const Candidate& candidate : candidates()) {
        CAPTURE(describe(candidate));
        const Searcher searcher(searched_discs(), candidate, 10.0, false, {.engine = engine});
        SearchScratch scratch;
        for (const std::size_t count : {300UL, 40UL, 1UL, 300UL}) {
          const std::vector<Ray> rays = rays_of(count, count);
          const Outcome expected = run(make_problem(rays, searched_discs()), candidate, {.engine = engine});
          const Outcome& found = searcher.search(rays, scratch, {.engine = engine});
          CHECK(same(found, expected));
          CHECK(found.spheres.size() == expected.spheres.size());
        }
      }
  }

#ifndef DETP_SANITIZED
  TEST_CASE("A search repeated at the same size on one thread takes nothing from the heap") {
    const std::vector<Ray> rays = rays_of(5, 400);
    for (const Engine engine : {Engine::simd, Engine::plain})
      for (const bool count : {false, true})
        for (const Candidate& candidate : candidates()) {
          CAPTURE(describe(candidate));
          const RunOptions options{.count = count, .engine = engine};
          const Searcher searcher(searched_discs(), candidate, 10.0, false, options);
          SearchScratch scratch;
          for (int i = 0; i < 2; ++i) (void)searcher.search(rays, scratch, options);
          const std::uint64_t before = allocations();
          (void)searcher.search(rays, scratch, options);
          CHECK(allocations() == before);
          (void)run(make_problem(rays, searched_discs()), candidate, options);
          CHECK(allocations() > before);  // the counter works
        }
  }

  TEST_CASE("Views of floats are searched without a heap too") {
    std::vector<std::array<float, 8>> packed;
    for (const Ray& ray : rays_of(6, 200)) {
      const glm::vec3 o(ray.origin);
      const glm::vec3 d(ray.direction);
      packed.push_back({o.x, o.y, o.z, 0, d.x, d.y, d.z, static_cast<float>(ray.length)});
    }
    const Searcher searcher(searched_discs(), {Technique::box_tree, BoxTreeParameters{}});
    SearchScratch scratch;
    const RaysView view{packed.size(), {packed[0].data(), 32}, {&packed[0][4], 32}, {&packed[0][7], 32}};
    for (int i = 0; i < 2; ++i) (void)searcher.search(view, scratch);
    const std::uint64_t before = allocations();
    (void)searcher.search(view, scratch);
    CHECK(allocations() == before);
  }
#endif

  TEST_CASE("Rays and discs in floats or doubles, in one array or several, give the hits of the same numbers") {
    std::vector<Ray> rays = rays_of(9, 250);
    std::vector<Disc> some(searched_discs().begin(), searched_discs().begin() + 200);
    const auto in_floats = [](glm::dvec3& v) { v = glm::dvec3(glm::vec3(v)); };
    std::vector<float> origins;
    std::vector<float> directions;
    std::vector<double> centres;
    std::vector<std::array<float, 4>> normals_and_radii;
    for (Ray& ray : rays) {
      in_floats(ray.origin);
      in_floats(ray.direction);  // no longer unit: the searcher and make_problem must normalise alike
      ray.length = unbounded;
      ray.power = 2;
      for (int k = 0; k < 3; ++k) origins.push_back(static_cast<float>(ray.origin[k]));
      for (int k = 0; k < 3; ++k) directions.push_back(static_cast<float>(ray.direction[k]));
    }
    for (Disc& disc : some) {
      in_floats(disc.normal);
      disc.radius = static_cast<double>(static_cast<float>(disc.radius));
      for (int k = 0; k < 3; ++k) centres.push_back(disc.centre[k]);
      const glm::vec3 n(disc.normal);
      normals_and_radii.push_back({n.x, n.y, n.z, static_cast<float>(disc.radius)});
    }
    const Candidate candidate{Technique::octree, OctreeParameters{3}};
    const Outcome expected = run(make_problem(rays, some), candidate);
    CHECK(expected.total_hits > 0);
    const Searcher searcher(
        DiscsView{some.size(), centres.data(), {normals_and_radii[0].data(), 16}, {&normals_and_radii[0][3], 16}},
        candidate);
    SearchScratch scratch;
    CHECK(same(searcher.search(RaysView{rays.size(), origins.data(), directions.data(), unbounded, 2.0}, scratch),
               expected));
    CHECK(same(searcher.search(rays, scratch), expected));
  }

  TEST_CASE("Coordinates in arrays of their own are read as those one after another, on any number of threads") {
    const std::vector<Ray> rays = rays_of(3, 20'000);
    std::array<std::vector<double>, 6> columns;
    for (const Ray& ray : rays)
      for (int k = 0; k < 3; ++k) {
        columns[static_cast<std::size_t>(k)].push_back(ray.origin[k]);
        columns[static_cast<std::size_t>(k) + 3].push_back(3 * ray.direction[k]);
      }
    const auto at = [&](std::size_t i) { return columns[i].data(); };
    const RaysView view{.count = rays.size(), .origins = {at(0), at(1), at(2)}, .directions = {at(3), at(4), at(5)}};
    std::vector<Ray> alone(rays.size());
    std::vector<Ray> together(rays.size());
    read_rays(view, 0, alone);
    read_rays(view, 0, together, 2);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      REQUIRE(alone[i].origin == rays[i].origin);
      REQUIRE(glm::length(alone[i].direction - rays[i].direction) < 1e-15);
      REQUIRE(together[i].direction == alone[i].direction);
    }
  }

  TEST_CASE("Seconds of a search include reading a view and checking rays; photon numbers reach the standard errors") {
    const std::vector<Ray> rays = rays_of(4, 50'000);
    const RaysView view{.count = rays.size(),
                        .origins = {&rays[0].origin.x, sizeof(Ray)},
                        .directions = {&rays[0].direction.x, sizeof(Ray)}};
    const Searcher searcher(searched_discs(), {Technique::box_tree, BoxTreeParameters{}}, 10.0);
    SearchScratch scratch;
    const Phases seconds = searcher.search(view, scratch).seconds;
    CHECK(seconds.prepare > 0);
    CHECK(seconds.total() == doctest::Approx(seconds.prepare + seconds.build + seconds.search));
    RaysView numbered = view;
    std::vector<std::uint64_t> photons;
    for (std::size_t i = 0; i < rays.size(); ++i) photons.push_back(i / 5);
    numbered.photons = photons;
    const std::vector<double> whole = searcher.search(numbered, scratch, {.standard_error = true}).standard_error;
    const Outcome expected = run(make_problem(PathRays{scratch.rays, photons, {}}, searched_discs()),
                                 {Technique::box_tree, BoxTreeParameters{}}, {.standard_error = true});
    CHECK(whole == expected.standard_error);
    CHECK(whole != searcher.search(view, scratch, {.standard_error = true}).standard_error);
  }

  TEST_CASE("A view is read in pieces; results are those of all rays at once, errors have the ray's number" *
            doctest::test_suite("long")) {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 20, 0.15, 3);
    std::vector<Ray> rays = rays_of(5, 450'000);
    std::vector<std::uint64_t> photons;
    for (std::size_t i = 0; i < rays.size();
         ++i)  // paths of 1 to 7 rays; one of 200 000 rays; some photons without rays
      photons.push_back(i == 0                                   ? 0
                        : i > 180'000 && i < 380'000             ? photons.back()
                        : uniform4(1, Stream::tests, i)[2] < 0.3 ? photons.back() + 3
                                                                 : photons.back());
    const RaysView view{.count = rays.size(),
                        .origins = {&rays[0].origin.x, sizeof(Ray)},
                        .directions = {&rays[0].direction.x, sizeof(Ray)},
                        .lengths = {&rays[0].length, sizeof(Ray)},
                        .powers = {&rays[0].power, sizeof(Ray)}};
    const auto with_photons = [&] {
      RaysView numbered = view;
      numbered.photons = photons;
      return numbered;
    };
    const std::vector<Candidate> all{{Technique::box_tree, BoxTreeParameters{}},
                                     {Technique::octree, OctreeParameters{3}},
                                     {Technique::ray_map, RayMapParameters{}},
                                     {Technique::sphere_cache, SphereCacheParameters{0.6, 4}}};
    SearchScratch scratch;
    for (const Candidate& candidate : all)
      for (const bool numbered : {false, true}) {
        CAPTURE(describe(candidate));
        const RunOptions options{.pairs = true, .standard_error = true, .threads = numbered ? 2 : 1};
        const std::vector<std::uint64_t> none;
        const Outcome expected =
            run(make_problem(PathRays{rays, numbered ? photons : none, {}}, discs), candidate, options);
        const Searcher searcher(discs, candidate, 10.0);
        const Outcome& found = searcher.search(numbered ? with_photons() : view, scratch, options);
        CHECK(same(found, expected));
        CHECK(found.standard_error == expected.standard_error);
        CHECK(found.upper_bound == expected.upper_bound);
        CHECK(found.pairs == expected.pairs);
        CHECK(found.counts.loaded == rays.size());
        CHECK(found.progress.done == rays.size());
      }
    const Searcher searcher(discs, all[0], 10.0);
    CHECK(searcher.search(view, scratch).total_hits > 0);
    CHECK(scratch.rays.size() <= 1U << 18);
    double last = 0;
    std::stop_source stop;
    const Outcome& partial = searcher.search(view, scratch, {.stop = stop.get_token(), .progress = [&](double share) {
                                                               CHECK(share >= last);
                                                               last = share;
                                                               if (share > 0.5) stop.request_stop();
                                                             }});
    CHECK(last <= 1);
    REQUIRE(partial.stopped);
    const auto done = static_cast<std::size_t>(partial.progress.done);
    REQUIRE(done > 1U << 17);
    CHECK(same(partial, run(make_problem(std::span(rays).first(done), discs), all[0])));
    rays[300'000].power = -1;
    CHECK_THROWS_WITH_AS((void)searcher.search(view, scratch), doctest::Contains("ray 300000: power"),
                         std::invalid_argument);
    rays[300'000].power = 1;
    photons[400'000] = 1;
    CHECK_THROWS_WITH_AS((void)searcher.search(with_photons(), scratch), doctest::Contains("ray 400000: its photon"),
                         std::invalid_argument);
    photons.resize(400'000);
    CHECK_THROWS_WITH_AS((void)searcher.search(with_photons(), scratch),
                         "there are 400000 photon numbers for 450000 rays; each ray needs one", std::invalid_argument);
  }

  TEST_CASE("Many threads search one searcher at once, each with a scratch of its own") {
    for (const Candidate& candidate : candidates()) {
      CAPTURE(describe(candidate));
      const Searcher searcher(searched_discs(), candidate, 10.0);
      std::array<std::uint64_t, 4> wrong{};
      std::vector<std::thread> threads;
      for (std::size_t t = 0; t < wrong.size(); ++t)
        threads.emplace_back([&, t] {
          SearchScratch scratch;
          for (std::uint64_t i = 0; i < 3; ++i) {
            const std::vector<Ray> rays = rays_of(10 * t + i + 1, 100 + 10 * t);
            const Outcome expected = run(make_problem(rays, searched_discs()), candidate);
            wrong[t] += same(searcher.search(rays, scratch), expected) ? 0 : 1;
          }
        });
      for (std::thread& thread : threads) thread.join();
      CHECK(wrong == std::array<std::uint64_t, 4>{});
    }
  }

  TEST_CASE("What cannot be searched is refused, and the searcher goes on") {
    const Searcher searcher(searched_discs(), {Technique::box_tree, BoxTreeParameters{}}, 10.0);
    SearchScratch scratch;
    std::vector<Ray> rays = rays_of(1, 5);
    CHECK_THROWS_WITH_AS((void)searcher.search(std::span<const Ray>(), scratch), "there must be at least one ray",
                         std::invalid_argument);
    rays[3].direction = {0, 0, 0};
    CHECK_THROWS_WITH_AS((void)searcher.search(rays, scratch), "ray 3: direction must be non-zero (got 0 0 0)",
                         std::invalid_argument);
    rays[3] = {{0, 0, 11}, {0, 0, 1}};
    CHECK_THROWS_WITH_AS((void)searcher.search(rays, scratch), doctest::Contains("the problem was made for at most 10"),
                         std::invalid_argument);
    const std::array<float, 3> nan{NAN, 0, 0};
    CHECK_THROWS_WITH_AS((void)searcher.search(RaysView{1, nan.data(), nan.data()}, scratch),
                         doctest::Contains("ray 0: origin must be finite"), std::invalid_argument);
    const float* const none = nullptr;
    CHECK_THROWS_WITH_AS((void)searcher.search(RaysView{1, nan.data(), none}, scratch),
                         "the array of directions is null", std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)searcher.search(RaysView{1, nan.data(), {nan.data(), none, nan.data()}}, scratch),
                         "the array of directions is null", std::invalid_argument);
    for (const int threads : {-1, 1'000'000})
      CHECK_THROWS_WITH_AS((void)searcher.search(RaysView{1, nan.data(), nan.data()}, scratch, {.threads = threads}),
                           doctest::Contains("number of threads"), std::invalid_argument);
    CHECK_THROWS_WITH_AS(Searcher({}, {Technique::box_tree, BoxTreeParameters{}}), "there must be at least one disc",
                         std::invalid_argument);
    CHECK_THROWS_AS(Searcher(searched_discs(), {Technique::box_tree, GridParameters{}}), std::invalid_argument);
    CHECK(searcher.search(rays_of(1, 5), scratch).progress.done == 5);
  }
}
