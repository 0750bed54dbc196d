#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "support/candidates.hpp"
#include "support/same_bytes.hpp"

namespace detp::sim {
namespace {

using support::one_of_each;

constexpr std::size_t bands = 12;

/// Powers that span ten decades; those of band 2 are equal, those of band 3 are 0, those of band 4 beyond the usual unit of squares.
std::vector<double> powers_of(std::size_t rays, std::size_t seed = 6) {
  std::vector<double> powers;
  for (std::size_t ray = 0; ray < rays; ++ray)
    for (std::size_t band = 0; band < bands; ++band) {
      const double power = std::pow(10, 10 * uniform4(seed + band, Stream::tests, ray)[0]);
      powers.push_back(band == 2 ? 5.25 : band == 3 ? 0 : band == 4 ? 1e90 * power : power);
    }
  return powers;
}

/// The powers of one band.
std::vector<double> column(const std::vector<double>& powers, std::size_t band) {
  std::vector<double> one;
  for (std::size_t i = band; i < powers.size(); i += bands) one.push_back(powers[i]);
  return one;
}

/// The same paths, whose rays carry the powers, in all bands or in one.
Paths with_powers(Paths paths, const std::vector<double>& powers) {
  paths.further_bands = powers.size() / paths.rays.size() - 1;
  for (std::size_t ray = 0, next = 0; ray < paths.rays.size(); ++ray) {
    paths.rays[ray].power = powers[next++];
    for (std::size_t band = 0; band < paths.further_bands; ++band) paths.further.push_back(powers[next++]);
  }
  return paths;
}

/// What searches of one band each find, together.
template <class Search>
Outcome found_band_by_band(const Paths& paths, const std::vector<double>& powers, const Search& search) {
  Outcome all = search(with_powers(paths, column(powers, 0)));
  for (std::size_t band = 1; band < bands; ++band)
    all.further.push_back(search(with_powers(paths, column(powers, band))));
  return all;
}

/// Rays of the field; photons with up to three rays each, of several blocks of photons, or without numbers.
Paths some_paths(std::span<const Disc> discs, bool numbered) {
  Paths paths{support::uneven_lines(discs, 3000)};
  for (std::size_t ray = 0; numbered && ray < paths.rays.size(); ++ray) paths.photons.push_back(ray * ray / 90 / 3 * 3);
  return paths;
}

}  // namespace

TEST_SUITE("bands") {
  TEST_CASE("A search in 12 bands finds, band by band, the bytes of 12 searches: all techniques, engines, threads") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 60, 0.3, 3);
    for (const bool numbered : {false, true})
      for (const bool front_facing : {false, true})
        for (const bool errors : {false, true}) {
          CAPTURE(numbered);
          CAPTURE(front_facing);
          CAPTURE(errors);
          const Paths paths = some_paths(discs, numbered);
          const std::vector<double> powers = powers_of(paths.rays.size());
          const RunOptions options{.standard_error = errors};
          const Outcome expected = found_band_by_band(paths, powers, [&](const Paths& one) {
            return run(make_problem(one, discs, front_facing), {Technique::brute_force, BruteForceParameters{}},
                       options);
          });
          CHECK(std::ranges::count(expected.further[2].irradiance, 0) == std::ptrdiff_t(discs.size()));
          const Paths all = with_powers(paths, powers);
          support::check_same_by_all(make_problem(all, discs, front_facing), expected,
                                     {one_of_each(), support::both_engines, {1, 2}}, options);
        }
  }

  TEST_CASE("The same if all rays have the same powers") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 60, 0.3, 3);
    for (const bool numbered : {false, true}) {
      const Paths paths = some_paths(discs, numbered);
      std::vector<double> powers = powers_of(paths.rays.size());
      for (std::size_t i = bands; i < powers.size(); ++i) powers[i] = powers[i - bands];
      const RunOptions options{.standard_error = numbered};
      const Outcome expected = found_band_by_band(paths, powers, [&](const Paths& one) {
        return run(make_problem(one, discs), {Technique::brute_force, BruteForceParameters{}}, options);
      });
      support::check_same_by_all(make_problem(with_powers(paths, powers), discs), expected,
                                 {one_of_each(), support::both_engines, {1, 2}}, options);
    }
  }

  TEST_CASE("The same from a stream, and by totals of successive searches") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 60, 0.3, 3);
    const Paths paths = some_paths(discs, false);
    const std::vector<double> powers = powers_of(paths.rays.size());
    const Paths all = with_powers(paths, powers);
    const RunOptions options{.standard_error = true};
    for (const Candidate& candidate : one_of_each()) {
      CAPTURE(describe(candidate));
      const Outcome expected = run(make_problem(all, discs), candidate, options);
      const RaysInMemory source(all.rays, {all.further, bands - 1});
      support::check_same(run_streamed(discs, source, candidate, {.run = options, .block = 700}).outcome, expected,
                          options);
      Totals totals;
      totals.keep_errors();
      for (std::size_t first = 0; first < all.rays.size(); first += 1000) {
        PathRays part(std::span(all.rays).subspan(first, 1000));
        part.further = {std::span(all.further).subspan(first * (bands - 1), 1000 * (bands - 1)), bands - 1};
        (void)run(make_problem(part, discs), candidate, {.totals = &totals});
      }
      Outcome found;
      finish(totals, discs, found);
      CHECK(found.band(7).irradiance == expected.band(7).irradiance);
      CHECK(found.band(11).standard_error == expected.band(11).standard_error);
      CHECK_THROWS_WITH_AS((void)run(make_problem(paths, discs), candidate, {.totals = &totals}),
                           "rays have 1 bands, but earlier ones 12", std::invalid_argument);
    }
  }

  TEST_CASE("The same by all estimators from photons in a scene") {
    const Scene scene = open_scene({.name = "@cornell", .samples = 40});
    const TracedPaths traced = photon_paths(scene, 3000, 2);
    std::vector<Disc> discs;
    for (std::size_t i = 0; i < traced.rays.size() && discs.size() < 40; i += 50) {
      const Ray& ray = traced.rays[i];
      if (std::isfinite(traced.landings[i]))
        discs.push_back({ray.origin + traced.landings[i] * ray.direction, {0, 0, 1}, 0.3});
    }
    const std::vector<double> powers = powers_of(traced.rays.size());
    for (const EstimatorRecord& record : estimators) {
      if (record.needs_scene) continue;
      CAPTURE(record.name);
      const EstimateRequest request{.estimator = record.estimator,
                                    .candidate = {Technique::box_tree, BoxTreeParameters{8, 8}},
                                    .nearest = 30,
                                    .mesh = &scene.mesh};
      for (const int threads : {1, 2}) {
        const RunOptions options{.standard_error = true, .threads = threads};
        const auto search = [&](const Paths& one) { return estimate(make_problem(one, discs), request, options); };
        support::check_same(search(with_powers(traced, powers)), found_band_by_band(traced, powers, search), options);
      }
    }
  }

  TEST_CASE("The same from views: rows with gaps, columns, floats; all rays at once or in pieces") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 60, 0.3, 3);
    const Candidate box_tree{Technique::box_tree, BoxTreeParameters{8, 8}};
    const Searcher searcher(discs, box_tree, 10.0);
    SearchScratch scratch;
    for (const std::size_t count : {std::size_t{3000}, (std::size_t{1} << 18) + 1000}) {
      const std::vector<Ray> rays = support::uneven_lines(discs, count);
      struct Spectrum {
        double unused;
        float power[3];
      };
      std::vector<Spectrum> rows(count);
      std::vector<float> columns[3];
      Paths paths{rays};
      paths.further_bands = 2;
      for (std::size_t i = 0; i < count; ++i) {
        const auto random = uniform4(9, Stream::tests, i);
        for (int band = 0; band < 3; ++band) {
          rows[i].power[band] = static_cast<float>(random[static_cast<std::size_t>(band)]);
          columns[band].push_back(rows[i].power[band]);
          if (band > 0) paths.further.push_back(rows[i].power[band]);
        }
        paths.rays[i].power = rows[i].power[0];
      }
      const RunOptions options{.standard_error = true};
      const Outcome expected = run(make_problem(paths, discs), box_tree, options);
      RaysView view{.count = count,
                    .origins = {&rays[0].origin.x, sizeof(Ray)},
                    .directions = {&rays[0].direction.x, sizeof(Ray)}};
      view.set_powers(rows[0].power, 3, sizeof(Spectrum));
      support::check_same(searcher.search(view, scratch, options), expected, options);
      view.powers = columns[0].data();
      view.further_powers = {columns[1].data(), columns[2].data()};
      support::check_same(searcher.search(view, scratch, options), expected, options);
    }
  }

  TEST_CASE("Malformed powers are refused with the numbers of ray and band") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 3, 0.3, 3);
    const Paths paths{support::uneven_lines(discs, 4)};
    const auto refuse = [&](std::vector<double> further, std::size_t count, const char* why) {
      PathRays rays = paths;
      rays.further = {further, count};
      CHECK_THROWS_WITH_AS((void)make_problem(rays, discs), doctest::Contains(why), std::invalid_argument);
    };
    refuse({1, 2, 3, 4, 5, -1, 7, 8}, 2, "ray 2: power of band 2 must be 0 to ");
    refuse({1, std::numeric_limits<double>::quiet_NaN(), 3, 4}, 1, "ray 1: power of band 1 ");
    refuse({1, 2, 3, unbounded}, 1, "ray 3: power of band 1 ");
    refuse({1, 2, 3}, 1, "there are 3 powers of 1 further bands for 4 rays");
    refuse(std::vector<double>(4 * 64), 64, "65 bands are too many; the maximum is 64");
  }
}

}  // namespace detp::sim
