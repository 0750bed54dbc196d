#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>
#include <string>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/pilot.hpp"
#include "detp/validate/job/job.hpp"
#include "support/scratch_file.hpp"

namespace detp::support {

// Meshes with dense objects that few rays reach, as OBJ files.

class SparseScene {
 public:
  explicit SparseScene(std::uint64_t seed) : seed_(seed) {}

  /// A number between the two, with a uniform logarithm.
  double between(double least, double most) {
    return least * std::pow(most / least, sim::uniform4(seed_, sim::Stream::tests, drawn_++)[0]);
  }

  /// A square floor of 10 x 10 with (cells + 1)² vertices.
  void floor(int cells) { square({0, 0, 0}, {10, 0, 0}, {0, 0, 10}, cells); }

  /// A sphere of about so many vertices.
  void sphere(double x, double y, double z, double radius, double vertices) {
    const int rings = static_cast<int>(std::sqrt(0.5 * vertices));
    const int first = vertices_ + 1;
    for (int i = 0; i <= rings; ++i)
      for (int j = 0; j < 2 * rings; ++j) {
        const double polar = std::numbers::pi * i / rings;
        const double around = std::numbers::pi * j / rings;
        vertex(x + radius * std::sin(polar) * std::cos(around), y + radius * std::cos(polar),
               z + radius * std::sin(polar) * std::sin(around));
      }
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < 2 * rings; ++j) {
        const int next = (j + 1) % (2 * rings);
        const int ring = first + 2 * rings * i;
        quad(ring + j, ring + next, ring + 2 * rings + next, ring + 2 * rings + j);
      }
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  /// A parallelogram of cells² quads.
  void square(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, int cells) {
    const int first = vertices_ + 1;
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j <= cells; ++j) {
        const glm::dvec3 place = corner + u * (1.0 * i / cells) + v * (1.0 * j / cells);
        vertex(place.x, place.y, place.z);
      }
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const int low = first + i * (cells + 1) + j;
        quad(low, low + 1, low + cells + 2, low + cells + 1);
      }
  }
  void vertex(double x, double y, double z) {
    text_ += fmt::format("v {:.7g} {:.7g} {:.7g}\n", x, y, z);
    ++vertices_;
  }
  void quad(int a, int b, int c, int d) { text_ += fmt::format("f {} {} {}\nf {} {} {}\n", a, b, c, a, c, d); }

  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  int vertices_ = 0;
  std::string text_;
};

/// A tiny object on a huge floor.
inline std::string tiny_object(std::uint64_t seed) {
  SparseScene scene(seed);
  scene.floor(static_cast<int>(scene.between(1, 60)));
  const double radius = scene.between(0.01, 0.2);
  scene.sphere(scene.between(1, 9), radius, scene.between(1, 9), radius, scene.between(2000, 12'000));
  return scene.text();
}

/// Some dense objects on a floor.
inline std::string furnished_floor(std::uint64_t seed) {
  SparseScene scene(seed);
  scene.floor(static_cast<int>(scene.between(1, 20)));
  for (int left = static_cast<int>(scene.between(4, 30)); left > 0; --left) {
    const double radius = scene.between(0.02, 0.5);
    scene.sphere(scene.between(1, 9), radius, scene.between(1, 9), radius, scene.between(200, 2000));
  }
  return scene.text();
}

}  // namespace detp::support

using namespace detp;

namespace {

constexpr std::array judged{&Counts<double>::cull_tests, &Counts<double>::culls,      &Counts<double>::listed,
                            &Counts<double>::visits,     &Counts<double>::disc_tests, &Counts<double>::hits};

/// How many counts of choices are within two stated errors.
struct Coverage {
  int all = 0;
  int inside = 0;
  int wrong_without_error = 0;

  void add(const Prediction& choice, const Counts<double>& counted) {
    for (const auto term : judged) {
      const double off = std::abs(choice.counts.*term - counted.*term);
      const double error = choice.counts_error.*term;
      ++all;
      inside += off <= 2 * error + 1e-6 * counted.*term ? 1 : 0;
      wrong_without_error += error == 0 && off > 0 ? 1 : 0;
    }
  }
};

void search_sparse(const std::string& mesh, std::uint64_t seed, Coverage& coverage) {
  const support::ScratchFolder folder;
  validate::JobRequest request;
  request.scene = folder.file("scene.obj", mesh);
  request.rays = 30'000 + 10'000 * static_cast<double>(seed % 4);
  request.disc_radius = validate::Length{std::array{0.002, 0.006, 0.035}[seed % 3], true};
  request.field = seed % 4 == 0 ? sim::Field::isotropic : sim::Field::photons;
  request.effects = sim::EffectSelection("none");
  request.seed = seed;
  const validate::Job job = validate::make_job(request);
  const sim::Problem& problem = job.problem();
  const auto found =
      validate::choose({.problem = &problem, .workload = job.workload(), .disabled = {Technique::brute_force}},
                       validate::built_in_unit_costs());
  CAPTURE(seed);
  REQUIRE(found.best().candidate.technique == Technique::box_tree);
  coverage.add(found.best(), as_expected(sim::run(problem, found.best().candidate).counts));
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("where few rays reach the discs, nine of ten counts are within two stated errors; no wrong is exact" *
            doctest::test_suite("long")) {
    Coverage coverage;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      search_sparse(support::tiny_object(seed), seed, coverage);
      search_sparse(support::furnished_floor(seed), seed, coverage);
    }
    CHECK(coverage.all == 96);
    CHECK(coverage.inside >= 0.9 * coverage.all);
    CHECK(coverage.wrong_without_error == 0);
  }

  TEST_CASE("where few rays reach the discs, a pilot that has no other rays to draw from states a larger error") {
    const support::ScratchFolder folder;
    int larger = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      validate::JobRequest request;
      request.scene = folder.file("scene.obj", support::tiny_object(seed));
      request.rays = 40'000;
      request.disc_radius = validate::Length{0.02, true};
      request.effects = sim::EffectSelection("none");
      const validate::Job job = validate::make_job(request);
      const sim::Problem& problem = job.problem();
      const auto costs = validate::built_in_unit_costs();
      const auto with = validate::choose(
          {.problem = &problem, .workload = job.workload(), .disabled = {Technique::brute_force}}, costs);
      const auto sample = validate::pilot_sample(problem.rays(), problem.discs().size());
      const sim::Problem without_rays = sim::make_problem_without_rays(job.discs, problem.farthest());
      const auto without = validate::choose({.problem = &without_rays,
                                             .rays = sample,
                                             .ray_count = static_cast<double>(job.rays.size()),
                                             .workload = job.workload(),
                                             .disabled = {Technique::brute_force}},
                                            costs);
      CHECK(with.best().counts_error.disc_tests > 0);
      larger += without.best().counts_error.disc_tests > 1.2 * with.best().counts_error.disc_tests ? 1 : 0;
    }
    CHECK(larger >= 2);
  }
}
