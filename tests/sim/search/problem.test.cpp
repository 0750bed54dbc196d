#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/candidates.hpp"
#include "support/not_a_length.hpp"

using namespace detp;
using namespace detp::sim;
using detp::support::infinity;
using detp::support::not_a_number;

namespace {

constexpr double denormal = std::numeric_limits<double>::denorm_min();
const Candidate brute{Technique::brute_force, BruteForceParameters{}};

Outcome truth_of(const Problem& problem) { return run(problem, brute, {.pairs = true, .engine = Engine::plain}); }

/// Checks that every exact technique, with either engine, finds the same hits as the predicate.
void check_all_agree(const Problem& problem) {
  const Outcome expected = truth_of(problem);
  for (const Candidate& candidate : support::exact_candidates())
    for (const bool plain : {false, true}) {
      INFO("name(candidate.technique) ", name(candidate.technique), ", describe(candidate) ", describe(candidate),
           ", plain ", plain);
      const Outcome outcome = run(problem, candidate, {.pairs = true, .engine = plain ? Engine::plain : Engine::simd});
      CHECK(outcome.pairs == expected.pairs);
      CHECK(outcome.irradiance == expected.irradiance);
    }
}

/// The vector as normalised by a renderer in single precision.
glm::dvec3 in_floats(const glm::dvec3& vector) { return glm::dvec3(glm::normalize(glm::vec3(vector))); }

/// Three discs and three rays; tests replace each number in turn.
struct SmallInput {
  std::vector<Ray> rays = std::vector<Ray>(3, {.origin = {0.01, 0.02, -1}, .length = 3});
  std::vector<Disc> discs{{.centre = {0, 0, 0}, .radius = 0.1},
                          {.centre = {0, 0, 0.5}, .radius = 0.1},
                          {.centre = {0.1, 0, 0}, .radius = 0.1}};
};

struct Field {
  const char* name;
  std::function<double&(SmallInput&)> number;
};

const std::vector<Field>& fields() {
  static const std::vector<Field> list{
      {"ray 1: origin", [](SmallInput& given) -> double& { return given.rays[1].origin.x; }},
      {"ray 1: origin", [](SmallInput& given) -> double& { return given.rays[1].origin.z; }},
      {"ray 1: direction", [](SmallInput& given) -> double& { return given.rays[1].direction.y; }},
      {"ray 1: length", [](SmallInput& given) -> double& { return given.rays[1].length; }},
      {"ray 1: power", [](SmallInput& given) -> double& { return given.rays[1].power; }},
      {"disc 1: centre", [](SmallInput& given) -> double& { return given.discs[1].centre.y; }},
      {"disc 1: normal", [](SmallInput& given) -> double& { return given.discs[1].normal.x; }},
      {"disc 1: radius", [](SmallInput& given) -> double& { return given.discs[1].radius; }}};
  return list;
}

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("for any number in a ray or a disc, it is refused by name and number or all techniques agree") {
    const std::vector<double> numbers{not_a_number, infinity, -infinity, 0.0,     -0.0,   denormal, -denormal,
                                      1e-320,       1e-300,   1e-160,    -1e-160, 1e-100, 1e-99,    1e-12,
                                      1e-7,         -1.0,     1e7,       1e30,    1e90,   9e99,     2e100,
                                      -2e100,       1e155,    1e160,     1e300,   -1e308};
    int refused = 0;
    for (const Field& field : fields())
      for (const double number : numbers) {
        INFO("field.name ", field.name, ", number ", number);
        SmallInput given;
        field.number(given) = number;
        const bool never = std::isnan(number) || number == -infinity || (number == infinity && field.name[7] != 'l');
        try {
          const Problem problem = make_problem(given.rays, given.discs);
          CHECK_FALSE(never);
          CHECK(problem.slack() > 0);
          CHECK(problem.slack() < 1e100);
          check_all_agree(problem);
          for (const double irradiance : truth_of(problem).irradiance) CHECK(std::isfinite(irradiance));
        } catch (const std::invalid_argument& error) {
          ++refused;
          const std::string message = error.what();
          CHECK((message.starts_with(field.name) || message.find("within 1e100 of each other") != std::string::npos));
        }
      }
    CHECK(refused > 60);
    CHECK(refused < 120);
  }

  TEST_CASE("a length of minus infinity does not make a line") {
    SmallInput given;
    given.rays[2].length = -infinity;
    CHECK_THROWS_WITH_AS((void)make_problem(given.rays, given.discs), "ray 2: length must be > 0 and finite (got -inf)",
                         std::invalid_argument);
    CHECK_FALSE(given.rays[2].is_line());
  }

  TEST_CASE("a vector that cannot be normalised is refused with its number, whichever thread finds it") {
    std::vector<Ray> rays(100'000, {.direction = {0, 0, 2}});
    rays[70'017].direction = glm::dvec3{0};
    rays[99'999].length = -1;
    for (const int threads : {1, 2})
      CHECK_THROWS_WITH_AS((void)make_problem(rays, SmallInput{}.discs, false, threads),
                           "ray 70017: direction must be non-zero (got 0 0 0)", std::invalid_argument);
    Problem problem = make_problem_without_rays(SmallInput{}.discs, 10);
    CHECK_THROWS_WITH_AS(set_rays(problem, rays, 1, 1'000'000), "ray 1070017: direction must be non-zero (got 0 0 0)",
                         std::invalid_argument);
    CHECK(problem.rays().empty());
    SmallInput given;
    given.discs[2].normal = {0, -0.0, 0};
    CHECK_THROWS_WITH_AS((void)make_problem(given.rays, given.discs), "disc 2: normal must be non-zero (got 0 -0 0)",
                         std::invalid_argument);
  }

  TEST_CASE("powers whose sums or irradiance would overflow are refused") {
    SmallInput given;
    given.rays[0].power = 1e300;
    CHECK_THROWS_WITH_AS((void)make_problem(given.rays, given.discs), doctest::Contains("irradiance overflows"),
                         std::invalid_argument);
    given.rays[0].power = 1e280;
    CHECK(run(make_problem(given.rays, given.discs), brute).irradiance[0] < infinity);
  }

  TEST_CASE("no discs, or discs at infinity, have no enclosing sphere") {
    CHECK_THROWS_WITH_AS((void)enclosing_sphere({}), "there must be at least one disc", std::invalid_argument);
    for (const double bad : {not_a_number, infinity, 1e160}) {
      std::vector<Disc> discs = SmallInput{}.discs;
      discs[1].centre.x = bad;
      CHECK_THROWS_WITH_AS((void)enclosing_sphere(discs), doctest::Contains("disc 1: centre must be"),
                           std::invalid_argument);
    }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("rays that all pass one disc at a distance hit nothing with any technique") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 0.1}};
    const std::vector<Ray> rays{{{0, 5, 0}, {1, 0, 0}}, {{0, 0, 7}, {0, 1, 0}}};
    const Problem problem = make_problem(rays, discs);
    CHECK(truth_of(problem).total_hits == 0);
    check_all_agree(problem);
  }

  TEST_CASE("with directions and normals that are normalised in floats, or not at all, all techniques agree") {
    auto discs = uniform_discs(Body::cube, 2, 300, 0.1, 5);
    auto rays = LineField(enclosing_sphere(discs), 6).lines(0, 400);
    for (std::size_t i = 0; i < rays.size(); i += 2) rays[i].length = 1;
    const Outcome exact = truth_of(make_problem(rays, discs));
    for (const double stretch : {1.0, 1e-310, 1e300}) {
      CAPTURE(stretch);
      auto some_discs = discs;
      auto some_rays = rays;
      for (Disc& disc : some_discs) disc.normal = in_floats(disc.normal) * stretch;
      for (Ray& ray : some_rays) ray.direction = in_floats(ray.direction) * stretch;
      const Problem problem = make_problem(some_rays, some_discs);
      check_all_agree(problem);
      for (Disc& disc : some_discs) disc.normal = unit_or_zero(disc.normal);
      for (Ray& ray : some_rays) ray.direction = unit_or_zero(ray.direction);
      const Outcome outcome = truth_of(problem);
      CHECK(outcome.pairs == truth_of(make_problem(some_rays, some_discs)).pairs);
      CHECK(outcome.total_hits > 100);
      CHECK(std::abs(static_cast<double>(outcome.total_hits) - static_cast<double>(exact.total_hits)) < 5);
    }
  }

  TEST_CASE("vectors that have unit length already are not copied, and stay in place") {
    const SmallInput given;
    const Problem problem = make_problem(given.rays, given.discs);
    CHECK(problem.rays().data() == given.rays.data());
    CHECK(problem.discs().data() == given.discs.data());
    SmallInput off;
    off.rays[1].direction = {0, 0, 1 + 1e-7};
    const Problem copied = make_problem(off.rays, off.discs);
    CHECK(copied.rays().data() != off.rays.data());
    CHECK(copied.rays()[1].direction.z == 1);
    CHECK(copied.rays()[1].length == 3);
    CHECK(copied.discs().data() == off.discs.data());
    const Problem again = copied;  // a copy of the problem refers to the same rays
    CHECK(again.rays().data() == copied.rays().data());
  }

  TEST_CASE("the slack of the smallest discs does not underflow") {
    const std::vector<Disc> discs{{.centre = {0, 0, 0}, .radius = 1e-100},
                                  {.centre = {1e-100, 0, 0}, .radius = 1e-100}};
    const std::vector<Ray> rays{{.origin = {0, 0, -1e-100}}};
    const Problem tiny = make_problem(rays, discs);
    const std::vector<Disc> large_discs{{.centre = {0, 0, 0}, .radius = 1}, {.centre = {1, 0, 0}, .radius = 1}};
    const std::vector<Ray> large_rays{{.origin = {0, 0, -1}}};
    const Problem large = make_problem(large_rays, large_discs);
    CHECK(tiny.slack() == doctest::Approx(1e-100 * large.slack()).epsilon(1e-10));
    check_all_agree(tiny);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a problem knows the box of the centres, and the smallest, largest and root mean square radius") {
    const std::vector<Disc> discs{{.centre = {1, 5, 2}, .radius = 7}, {.centre = {3, 4, 2}, .radius = 1}};
    const Problem problem = make_problem_without_rays(discs, 100);
    CHECK(problem.centres().low == glm::dvec3(1, 4, 2));
    CHECK(problem.centres().high == glm::dvec3(3, 5, 2));
    CHECK(problem.radii().smallest == 1);
    CHECK(problem.radii().largest == 7);
    CHECK(problem.radii().rms == 5);
    const std::vector<Disc> equal(10, {.radius = 1e-100});
    CHECK(make_problem_without_rays(equal, 1).radii().rms == 1e-100);
  }
}
