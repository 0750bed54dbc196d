#include "detp/validate/job/outliers.hpp"

#include <doctest/doctest.h>

#include <string>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/validate/job/job.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

std::vector<sim::Disc> many_discs(sim::Body body = sim::Body::cube) {
  return sim::uniform_discs(body, 2, 10'000, 0.02, 1);
}

std::vector<sim::Ray> lines_through(const std::vector<sim::Disc>& discs) {
  return sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 100);
}

std::vector<std::string> warnings_of(const std::vector<sim::Disc>& discs) {
  const auto rays = lines_through(discs);
  return outlier_warnings(sim::make_problem(rays, discs));
}

void check_one(const std::vector<std::string>& warnings, const std::vector<std::string>& named) {
  REQUIRE(warnings.size() == 1);
  CAPTURE(warnings[0]);
  for (const std::string& part : named) CHECK(warnings[0].find(part) != std::string::npos);
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("one large disc among small ones is named, with the radius that the models use for all") {
    auto discs = many_discs();
    discs[77].radius = 50;
    check_one(warnings_of(discs),
              {"1 of 10000 discs has a radius of 50", "2.5e+03 times the median 0.02", "root mean square 0.5004"});
    for (std::size_t i = 0; i < 100; ++i)
      discs[100 * i].radius = 0.1;  // five times the median: the mean square changes by a fifth
    discs[77].radius = 0.02;
    check_one(warnings_of(discs), {"100 of 10000 discs have radii up to 0.1"});
  }

  TEST_CASE("the warning of one disc far away, or one in a hundred, has the sizes of the boxes") {
    for (const sim::Body body : {sim::Body::cube, sim::Body::cube_faces}) {
      auto discs = many_discs(body);
      discs[5].centre = {0, 2000, 0};
      check_one(warnings_of(discs), {"1 of 10000 discs lies far from the others", "2e+03 long", "percentages"});
      for (std::size_t i = 0; i < 100; ++i) discs[100 * i + 5].centre = {30, 0, 0};
      check_one(warnings_of(discs), {"100 of 10000 discs lie far from the others"});
    }
  }

  TEST_CASE("the warning of a ray that starts far outside has its distance; a ray that starts near has no warning") {
    const auto discs = many_discs();
    auto rays = lines_through(discs);
    rays[3].origin = {1e6, 0, 0};
    check_one(outlier_warnings(sim::make_problem(rays, discs)), {"1 of 100 rays starts far outside", "1e+06", "S0"});
    rays[3].origin = {20, 0, 0};
    CHECK(outlier_warnings(sim::make_problem(rays, discs)).empty());
  }

  TEST_CASE("all three at once give three warnings") {
    auto discs = many_discs();
    auto rays = lines_through(discs);
    discs[77].radius = 50;
    discs[5].centre = {0, 2000, 0};
    rays[3].origin = {1e9, 0, 0};
    CHECK(outlier_warnings(sim::make_problem(rays, discs)).size() == 3);
  }

  TEST_CASE("ordinary sets give no warning: uniform, on faces, few, in one place, radii within a factor of four") {
    CHECK(warnings_of(many_discs()).empty());
    CHECK(warnings_of(many_discs(sim::Body::cube_faces)).empty());
    auto discs = many_discs();
    for (std::size_t i = 0; i < discs.size(); ++i) discs[i].radius *= 1 + 3 * static_cast<double>(i % 100) / 100;
    CHECK(warnings_of(discs).empty());
    for (sim::Disc& disc : discs) disc.centre = {1, 2, 3};
    CHECK(warnings_of(discs).empty());
    CHECK(warnings_of(std::vector<sim::Disc>(1)).empty());
    CHECK(warnings_of({{}, {.centre = {5, 5, 5}}, {.centre = {5, 6, 5}}}).empty());
  }

  TEST_CASE("built-in scenes give no warning") {
    for (const std::string name :
         {"@uniform", "@tree", "@tree-coarse", "@courtyard", "@cornell", "@caustic", "@interior"}) {
      CAPTURE(name);
      JobRequest request;
      request.scene = name;
      request.rays = 1000;
      CHECK(make_job(request).warnings.empty());
    }
  }
}
