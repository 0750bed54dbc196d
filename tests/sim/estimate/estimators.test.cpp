#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/estimate/variable_radius.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::sim {
namespace {

const Candidate box_tree{Technique::box_tree, BoxTreeParameters{4, 8}};
constexpr int cells = 8;  // of the mesh, a side

/// The unit square z = 0 in cells, two triangles each; and a wall x = 0.
Mesh floor_and_wall() {
  Mesh mesh;
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) mesh.positions.emplace_back(double(x) / cells, double(y) / cells, 0);
  const auto at = [](int x, int y) { return static_cast<std::uint32_t>(y * (cells + 1) + x); };
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  const auto wall = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::dvec3& corner : {glm::dvec3(0, 0, 0), {0, 1, 0}, {0, 1, 1}, {0, 0, 1}})
    mesh.positions.push_back(corner);
  mesh.triangles.push_back({wall, wall + 1, wall + 2});
  mesh.triangles.push_back({wall, wall + 2, wall + 3});
  return mesh;
}

std::uint32_t triangle_at(double x, double y) {
  const int column = std::min(cells - 1, static_cast<int>(x * cells));
  const int row = std::min(cells - 1, static_cast<int>(y * cells));
  const bool upper = y * cells - row > x * cells - column;
  return static_cast<std::uint32_t>(2 * (row * cells + column) + (upper ? 1 : 0));
}

/// `per_photon` rays of each photon come down on the floor; the flux is 1 per unit area. The rays of a photon land side by side.
Paths even_light(std::uint64_t photons, std::uint64_t per_photon, std::uint64_t seed = 1) {
  Paths paths;
  paths.photon_count = photons;
  for (std::uint64_t photon = 0; photon < photons; ++photon) {
    const auto place = uniform4(seed, Stream::tests, photon);
    for (std::uint64_t i = 0; i < per_photon; ++i) {
      const double x = std::min(1.0, place[0] + 1e-7 * static_cast<double>(i));
      paths.rays.push_back({.origin = {x, place[1], 1},
                            .direction = {0, 0, -1},
                            .length = 1 + 1e-5,
                            .power = 1.0 / static_cast<double>(photons * per_photon)});
      paths.photons.push_back(photon);
      paths.landings.push_back(1);
      paths.triangles.push_back(triangle_at(x, place[1]));
    }
  }
  return paths;
}

/// In the middle of the floor; with edges also on its rim, half of each disc beyond it.
std::vector<Disc> discs_on_floor(bool edges) {
  std::vector<Disc> discs;
  for (int y = 1; y < 20; ++y)
    for (int x = 1; x < 20; ++x)
      if (x > 4 && x < 16 && y > 4 && y < 16) discs.push_back({{x / 20.0, y / 20.0, 0}, {0, 0, 1}, 0.06});
  if (edges)
    for (int y = 3; y < 18; ++y) discs.push_back({{1, y / 20.0, 0}, {0, 0, 1}, 0.06});
  return discs;
}

Outcome with(Estimator estimator, const Problem& problem, const Mesh& mesh, const RunOptions& options = {}) {
  return estimate(problem, {.estimator = estimator, .candidate = box_tree, .nearest = 60, .mesh = &mesh}, options);
}

std::vector<EstimatorRecord> of_photons() {
  std::vector<EstimatorRecord> all;
  std::ranges::copy_if(estimators, std::back_inserter(all), [](const auto& one) { return !one.needs_scene; });
  return all;
}

}  // namespace

TEST_SUITE("estimators") {
  TEST_CASE("even light: each estimator is unbiased, and its stated error is the one across seeds" *
            doctest::test_suite("long")) {
    const Mesh mesh = floor_and_wall();
    const auto discs = discs_on_floor(false);
    constexpr int seeds = 40;
    for (const EstimatorRecord& record : of_photons()) {
      CAPTURE(record.name);
      double sum = 0;
      double squares = 0;
      double stated = 0;
      std::vector<double> of_disc(discs.size());
      std::vector<double> squares_of_disc(discs.size());
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const Paths paths = even_light(12'000, 2, seed);
        const Outcome outcome = with(record.estimator, make_problem(paths, discs), mesh, {.standard_error = true});
        double mean = 0;
        for (std::size_t i = 0; i < discs.size(); ++i) {
          mean += outcome.irradiance[i] / static_cast<double>(discs.size());
          of_disc[i] += outcome.irradiance[i];
          squares_of_disc[i] += outcome.irradiance[i] * outcome.irradiance[i];
          REQUIRE(outcome.standard_error[i] < unbounded);
          stated += outcome.standard_error[i] * outcome.standard_error[i] / (seeds * static_cast<double>(discs.size()));
        }
        sum += mean;
        squares += mean * mean;
      }
      const double mean = sum / seeds;
      const double error = std::sqrt((squares / seeds - mean * mean) / (seeds - 1));
      // of nearest: landings in pairs make the k-th photon one of a pair, so k - 1 is 1/(2k) too large
      const double known = record.estimator == Estimator::nearest ? 0.5 / 60 : 0;
      CHECK(std::abs(mean - 1) < known + 4 * error);
      double found = 0;
      for (std::size_t i = 0; i < discs.size(); ++i)
        found +=
            (squares_of_disc[i] - of_disc[i] * of_disc[i] / seeds) / (seeds - 1) / static_cast<double>(discs.size());
      CHECK(std::sqrt(stated / found) == doctest::Approx(1).epsilon(0.08));
    }
  }

  TEST_CASE("pieces of one photon are no independent photons: without numbers, errors are stated too small") {
    const Mesh mesh = floor_and_wall();
    const auto discs = discs_on_floor(false);
    const Paths paths = even_light(4000, 4);
    const PathRays without(paths.rays, {}, paths.landings, 0, paths.triangles);
    for (const EstimatorRecord& record : of_photons()) {
      CAPTURE(record.name);
      const Outcome right = with(record.estimator, make_problem(paths, discs), mesh, {.standard_error = true});
      const Outcome wrong = with(record.estimator, make_problem(without, discs), mesh, {.standard_error = true});
      double ratio = 0;
      double count = 0;
      for (std::size_t i = 0; i < discs.size(); ++i)
        if (right.standard_error[i] < unbounded && wrong.standard_error[i] < unbounded) {
          ratio += wrong.standard_error[i] / right.standard_error[i];
          ++count;
        }
      REQUIRE(count > 50);
      CHECK(ratio / count < 0.6);  // 1/√4
    }
  }

  TEST_CASE("at the floor's rim discs lose half the light; area correction does not, and its wall does not count") {
    const Mesh mesh = floor_and_wall();
    std::vector<Disc> rim;
    for (int y = 3; y < 18; ++y)
      for (const double x : {0.0, 1.0}) rim.push_back({{x, y / 20.0, 0}, {0, 0, 1}, 0.06});
    const Paths paths = even_light(200'000, 1);
    const Problem problem = make_problem(paths, rim);
    const auto mean = [&](Estimator estimator) {
      double sum = 0;
      for (const double one : with(estimator, problem, mesh).irradiance) sum += one / static_cast<double>(rim.size());
      return sum;
    };
    CHECK(mean(Estimator::disc) == doctest::Approx(0.5).epsilon(0.03));
    CHECK(mean(Estimator::area_corrected) == doctest::Approx(1).epsilon(0.03));
    CHECK(mean(Estimator::triangle_hits) == doctest::Approx(1).epsilon(0.03));
    CHECK(mean(Estimator::nearest) == doctest::Approx(0.5).epsilon(0.05));
  }

  TEST_CASE("triangle hits: a vertex has the photons of its triangles over their area; in between it is linear") {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
    Paths paths;
    const auto land = [&](double x, double y, double power, std::uint32_t triangle) {
      paths.rays.push_back({.origin = {x, y, 1}, .direction = {0, 0, -1}, .length = 1, .power = power});
      paths.landings.push_back(1);
      paths.triangles.push_back(triangle);
    };
    land(0.1, 0.1, 3, 0);
    land(0.9, 0.9, 5, 1);
    land(0.2, 0.1, 1, 0);
    land(0.5, 0.5, 100, no_triangle);
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 0.1},
                                  {{1, 1, 0}, {0, 0, 1}, 0.1},
                                  {{1, 0, 0}, {0, 0, 1}, 0.1},
                                  {{0.5, 0, 0}, {0, 0, 1}, 0.1}};
    const Outcome outcome = with(Estimator::triangle_hits, make_problem(paths, discs), mesh);
    CHECK(outcome.irradiance[0] == doctest::Approx(8));   // (3 + 1)/0.5
    CHECK(outcome.irradiance[1] == doctest::Approx(10));  // 5/0.5
    CHECK(outcome.irradiance[2] == doctest::Approx(9));   // (3 + 1 + 5)/1
    CHECK(outcome.irradiance[3] == doctest::Approx(8.5));
    CHECK(outcome.hits == std::vector<std::uint64_t>{2, 1, 3, 3});
  }

  TEST_CASE("variable radius: many hits make small discs, few hits large ones, within the limits") {
    const std::vector<Disc> discs(5, Disc{{0, 0, 0}, {0, 0, 1}, 2});
    const std::vector<std::uint64_t> hits{9, 39, 2, 0, 4999};
    const auto changed = discs_of_pilot(discs, hits, usual_hits(hits));
    // median of 2, 9, 39, 4999: the upper middle, 39
    CHECK(changed[0].radius == doctest::Approx(4));
    CHECK(changed[1].radius == doctest::Approx(2));
    CHECK(changed[3].radius == doctest::Approx(2 * most_growth));
    CHECK(changed[4].radius == doctest::Approx(2 / most_growth));
    const std::vector<std::uint64_t> none(5, 0);
    CHECK(discs_of_pilot(discs, none, usual_hits(none))[0].radius == 2);
  }

  TEST_CASE("variable radius: photons in order of their light are no worse, and none is left out") {
    const Mesh mesh = floor_and_wall();
    const std::vector<Disc> discs{{{0.25, 0.5, 0}, {0, 0, 1}, 0.1}, {{0.75, 0.5, 0}, {0, 0, 1}, 0.1}};
    Paths paths{.rays = {}};
    constexpr int photons = 20'000;
    for (int i = 0; i < 2 * photons; ++i) {  // first all of the left half, then all of the right half
      const double u = std::fmod(i * 0.6180339887498949, 1.0);
      const double v = std::fmod(i * 0.7548776662466927, 1.0);
      paths.rays.push_back({{0.5 * u + (i < photons ? 0 : 0.5), v, 1}, {0, 0, -1}, 1.1, 0.5 / photons});
      paths.photons.push_back(static_cast<std::uint64_t>(i));
    }
    paths.photon_count = 2 * photons;
    const Outcome found = with(Estimator::variable_radius, make_problem(paths, discs), mesh, {.standard_error = true});
    for (std::size_t disc = 0; disc < 2; ++disc) {
      CHECK(found.irradiance[disc] == doctest::Approx(1).epsilon(0.03));
      CHECK(found.standard_error[disc] < 0.08);
    }
    CHECK(found.progress.done == 2 * photons);
    // All photons meet the disc: the error is 0, and the bound is a number.
    Paths all{.rays = std::vector<Ray>(1000, Ray{{0.25, 0.5, 1}, {0, 0, -1}, 1.1, 1})};
    const Outcome sure = with(Estimator::variable_radius, make_problem(PathRays(all.rays), std::span(discs).first(1)),
                              mesh, {.standard_error = true});
    CHECK(sure.hits[0] == 1000);
    CHECK(sure.upper_bound[0] >= sure.irradiance[0]);
  }

  TEST_CASE("results are the same bytes on any number of threads") {
    const Mesh mesh = floor_and_wall();
    const auto discs = discs_on_floor(true);
    const Paths paths = even_light(20'000, 2);
    const Problem problem = make_problem(paths, discs);
    for (const EstimatorRecord& record : of_photons()) {
      CAPTURE(record.name);
      const Outcome one = with(record.estimator, problem, mesh, {.standard_error = true});
      const Outcome four = with(record.estimator, problem, mesh, {.standard_error = true, .threads = 4});
      CHECK(one.irradiance == four.irradiance);
      CHECK(one.standard_error == four.standard_error);
      CHECK(one.upper_bound == four.upper_bound);
      CHECK(one.hits == four.hits);
      CHECK(one.total_hits > 0);
    }
  }

  TEST_CASE("light on one side only: with front_facing, a sample that faces away has none") {
    const Mesh mesh = floor_and_wall();
    std::vector<Disc> discs = discs_on_floor(false);
    for (Disc& disc : discs) disc.normal = {0, 0, -1};
    const Paths paths = even_light(20'000, 1);
    for (const EstimatorRecord& record : of_photons()) {
      CAPTURE(record.name);
      CHECK(with(record.estimator, make_problem(paths, discs), mesh).irradiance[0] > 0.5);
      for (const double irradiance : with(record.estimator, make_problem(paths, discs, true), mesh).irradiance)
        CHECK(irradiance == 0);
    }
  }

  TEST_CASE("a stop request ends each estimator, and the outcome says so") {
    const Mesh mesh = floor_and_wall();
    const auto discs = discs_on_floor(true);
    const Paths paths = even_light(20'000, 1);
    std::stop_source source;
    source.request_stop();
    for (const EstimatorRecord& record : of_photons()) {
      CAPTURE(record.name);
      CHECK(with(record.estimator, make_problem(paths, discs), mesh, {.stop = source.get_token()}).stopped);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an estimator that lacks something says what") {
    const Mesh mesh = floor_and_wall();
    const Mesh no_mesh;
    const auto discs = discs_on_floor(false);
    const Paths paths = even_light(100, 1);
    const PathRays no_triangles(paths.rays, paths.photons, paths.landings);
    const auto refuses = [&](const PathRays& rays, Estimator estimator, const Mesh& of, const char* why,
                             const RunOptions& options = {}) {
      CHECK_THROWS_WITH_AS((void)with(estimator, make_problem(rays, discs), of, options), doctest::Contains(why),
                           std::invalid_argument);
    };
    for (const Estimator estimator : {Estimator::area_corrected, Estimator::triangle_hits}) {
      refuses(paths, estimator, no_mesh, "needs a mesh");
      refuses(no_triangles, estimator, mesh, "which triangles the photons met");
      refuses(paths, estimator, mesh, "no pairs", {.pairs = true});
      Totals totals;
      refuses(paths, estimator, mesh, "no totals", {.totals = &totals});
    }
    Paths wrong = paths;
    wrong.triangles[3] = 130;
    refuses(wrong, Estimator::triangle_hits, mesh, "met triangle 130, but the mesh has 130");
    wrong.triangles.pop_back();
    CHECK_THROWS_WITH_AS((void)make_problem(wrong, discs), doctest::Contains("triangles"), std::invalid_argument);
    refuses(std::span(paths.rays).first(1), Estimator::variable_radius, mesh, "more photons");
    CHECK_THROWS_WITH_AS(
        (void)estimate(make_problem(paths, discs), {.candidate = {Technique::photon_map, PhotonMapParameters{5}}}),
        doctest::Contains("needs a technique"), std::invalid_argument);
  }
}

}  // namespace detp::sim
