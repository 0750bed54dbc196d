#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "detp/sim/geometry/error_band.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "support/exact_geometry.hpp"
#include "support/hard_scene.hpp"
#include "support/machine.hpp"

using namespace detp::sim;
using namespace detp::support;

namespace {

/// Totals over the cases of a family.
struct TrialResult {
  std::uint64_t cases = 0;
  std::uint64_t hits = 0;     ///< exact hits
  std::uint64_t wrong = 0;    ///< wrong decisions
  std::uint64_t outside = 0;  ///< wrong decisions outside the error band
  double widest = 0;          ///< largest distance of a wrong decision from the boundary, in bands

  void add(bool truth, bool decided, double bands) {
    ++cases;
    hits += truth ? 1 : 0;
    if (truth == decided) return;
    ++wrong;
    outside += bands <= 1 ? 0 : 1;
    widest = std::max(widest, bands);
  }
};

/// Distance, in bands, from the nearest boundary at which a wrong decision is possible.
double distance_in_bands(const DiscBand& band, const ExactDisc& exact, bool line) {
  const double rim = std::abs(exact.beyond_rim()) / band.rim;
  if (line) return rim;
  return std::min(rim, std::min(std::abs(exact.ahead()), std::abs(exact.beyond_end())) / band.ends);
}

/// `judge` makes the decision that is compared with the exact one.
template <class Judge>
TrialResult try_discs(std::size_t family, std::uint64_t cases, const Judge& judge) {
  TrialResult result;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const auto [ray, disc] = hard_disc(families[family], family, i);
    const ExactDisc exact(ray, disc);
    const bool truth = exact.hit();
    const bool decided = judge(ray, disc);
    result.add(truth, decided, truth == decided ? 0 : distance_in_bands(error_band(ray, disc), exact, ray.is_line()));
  }
  return result;
}

template <class Judge>
TrialResult try_spheres(std::size_t family, std::uint64_t cases, const Judge& judge) {
  TrialResult result;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const auto [ray, sphere] = hard_sphere(families[family], family, i);
    const ExactSphere exact(ray, sphere);
    const bool truth = exact.hit();
    const bool decided = judge(ray, sphere);
    result.add(truth, decided, truth == decided ? 0 : std::abs(exact.beyond()) / error_band(ray, sphere));
  }
  return result;
}

const auto disc_predicate = [](const Ray& ray, const Disc& disc) { return hits(ray, disc); };
const auto sphere_predicate = [](const Ray& ray, const Sphere& sphere) { return hits(ray, sphere); };

void report(std::string_view shape, std::size_t family, const TrialResult& result) {
  MESSAGE(fmt::format("{} {:12} {:8} cases {:8} hits {:7} wrong {} outside the band, widest {:.3f}", shape,
                      families[family].name, result.cases, result.hits, result.wrong, result.outside, result.widest));
}

struct FamilyResult {
  TrialResult discs, spheres;
};

void check_all_families(std::uint64_t cases, bool print) {
  const auto results = in_parallel(families.size(), [&](std::size_t family) {
    return FamilyResult{try_discs(family, cases, disc_predicate), try_spheres(family, cases, sphere_predicate)};
  });
  double widest_disc = 0;
  double widest_sphere = 0;
  for (std::size_t family = 0; family < families.size(); ++family) {
    INFO(families[family].name);
    const auto& [discs, spheres] = results[family];
    CHECK(discs.outside == 0);
    CHECK(std::min(discs.hits, discs.cases - discs.hits) > cases / 20);  // both answers are frequent
    widest_disc = std::max(widest_disc, discs.widest);
    CHECK(spheres.outside == 0);
    CHECK(std::min(spheres.hits, spheres.cases - spheres.hits) > cases / 20);
    widest_sphere = std::max(widest_sphere, spheres.widest);
    if (print) report("disc", family, discs), report("sphere", family, spheres);
  }
  CHECK(widest_disc > 0.1);  // the bands are not much wider than necessary
  CHECK(widest_sphere > 0.1);
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("no hard ray is decided wrongly outside the error band, compared with exact integers") {
    check_all_families(6'000, false);
  }

  TEST_CASE("predicates with a small error are detected outside the band") {
    const auto larger_disc = [](const Ray& ray, Disc disc) {
      disc.radius *= 1 + 1e-13;
      return hits(ray, disc);
    };
    const auto larger_sphere = [](const Ray& ray, Sphere sphere) {
      sphere.radius *= 1 + 1e-13;
      return hits(ray, sphere);
    };
    const auto longer = [](Ray ray, const Disc& disc) {
      ray.length *= 1 + 1e-13;
      return hits(ray, disc);
    };
    CHECK(try_discs(0, 6'000, larger_disc).outside > 100);
    CHECK(try_discs(0, 6'000, longer).outside > 20);
    CHECK(try_spheres(0, 6'000, larger_sphere).outside > 100);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("ties of whole numbers are hits, and one ulp beyond is a miss") {
    // (3, 4, 0) lies on the rim of radius 5. Each number here is exact.
    const Disc disc{{0, 0, 0}, {0, 0, 1}, 5};
    const Ray tie{.origin = {3, 4, -2}, .direction = {0, 0, 1}, .length = 2};
    CHECK(hits(tie, disc));
    CHECK(ExactDisc(tie, disc).hit());
    CHECK(ExactDisc(tie, disc).beyond_rim() == 0);
    const Ray past{.origin = {3, std::nextafter(4.0, 5.0), -2}, .direction = {0, 0, 1}};
    CHECK_FALSE(hits(past, disc));
    CHECK_FALSE(ExactDisc(past, disc).hit());
    const Ray short_of_it{.origin = {3, 4, -2}, .direction = {0, 0, 1}, .length = std::nextafter(2.0, 1.0)};
    CHECK_FALSE(hits(short_of_it, disc));
    CHECK_FALSE(ExactDisc(short_of_it, disc).hit());
    const Ray to_sphere{.origin = {3, 4, -2}, .direction = {0, 0, 1}};
    CHECK(hits(to_sphere, Sphere{{0, 0, 0}, 5}));
    CHECK(ExactSphere(to_sphere, {{0, 0, 0}, 5}).hit());
    CHECK_FALSE(ExactSphere(to_sphere, {{0, 0, 0}, std::nextafter(5.0, 4.0)}).hit());
  }

  TEST_CASE("a segment in a disc's plane that ends before the disc does not hit") {
    for (std::uint64_t i = 0; i < 20'000; ++i) {
      RandomSequence random(50, i);
      const Disc disc{{random.uniform(), random.uniform(), random.uniform()}, random.normal(), 1};
      const glm::dvec3 direction = slanting(random, disc.normal, 0);
      const glm::dvec3 sideways = random.between(-1, 1) * glm::cross(disc.normal, direction);
      CHECK_FALSE(hits({disc.centre + sideways - 2.5 * direction, direction, 1.4}, disc));
      CHECK_FALSE(hits({disc.centre + sideways + 1.1 * direction, direction, 1.4}, disc));
    }
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("ten million exact decisions of hard rays: none is wrong outside the error band") {
    check_all_families(500'000, true);
  }
}
