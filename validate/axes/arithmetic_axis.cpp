#include <fmt/format.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "axes.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/technique/technique.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t rays_of_scene = 2000;
constexpr std::size_t discs_of_scene = 50;
constexpr double disc_size = 0.05;

struct PairScene {
  const char* name;
  std::vector<sim::Ray> rays;
  std::vector<sim::Disc> discs;
};

glm::dvec3 random_unit(const std::array<double, 4>& random) { return sim::uniform_direction(random[0], random[1]); }

/// Rays through points of the planes of discs in a cube: within two radii of a centre, or within `near_rim` of the rim. The cube's
/// centre has all coordinates `away`.
PairScene scene_of(const char* name, double away, double near_rim, std::uint64_t seed) {
  PairScene scene{name, {}, {}};
  const auto random = [&](std::uint64_t part, std::uint64_t i) {
    return sim::uniform4(seed, sim::Stream::tests, i, part);
  };
  for (std::size_t i = 0; i < discs_of_scene; ++i) {
    const auto place = random(1, i);
    scene.discs.push_back({{away + place[0], away + place[1], away + place[2]}, random_unit(random(2, i)), disc_size});
  }
  for (std::size_t i = 0; i < rays_of_scene; ++i) {
    const sim::Disc& disc = scene.discs[i % discs_of_scene];
    const auto place = random(3, i);
    const glm::dvec3 across = glm::normalize(glm::cross(disc.normal, random_unit(random(4, i))));
    const double radius = near_rim > 0 ? disc_size * (1 + near_rim * (2 * place[0] - 1)) : 2 * disc_size * place[0];
    const glm::dvec3 direction = random_unit(random(5, i));
    scene.rays.push_back({.origin = disc.centre + radius * across - place[1] * direction, .direction = direction});
  }
  return scene;
}

/// The definition of a hit by a line, in any arithmetic: the crossing of the plane is within the radius.
template <class Real>
bool crosses_disc(const sim::Ray& ray, const sim::Disc& disc) {
  const auto of = [](const glm::dvec3& v) { return std::array<Real, 3>{Real(v.x), Real(v.y), Real(v.z)}; };
  const auto d = of(ray.direction);
  const auto n = of(disc.normal);
  const auto o = of(ray.origin);
  const auto c = of(disc.centre);
  const std::array<Real, 3> w{Real(o[0] - c[0]), Real(o[1] - c[1]), Real(o[2] - c[2])};
  const Real facing = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
  if (facing == 0) return false;
  const Real height = n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
  Real square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Real off = w[axis] * facing - d[axis] * height;
    square += off * off;
  }
  const Real reach = Real(disc.radius) * facing;
  return square <= reach * reach;
}

/// For each ray and disc, whether it is hit.
struct Decisions {
  std::vector<char> hits;
  double seconds = 0;
};

template <class Real>
Decisions decisions(const PairScene& scene, const std::stop_token& stop) {
  const sim::Stopwatch watch;
  Decisions made;
  made.hits.reserve(scene.rays.size() * scene.discs.size());
  for (const sim::Ray& ray : scene.rays) {
    sim::StopCheck(stop, "deciding hits").now();
    for (const sim::Disc& disc : scene.discs) made.hits.push_back(crosses_disc<Real>(ray, disc) ? 1 : 0);
  }
  made.seconds = watch.seconds();
  return made;
}

Decisions decisions_by(const PairScene& scene, Engine engine) {
  const sim::Problem problem = sim::make_problem(scene.rays, scene.discs);
  const Candidate brute_force{Technique::brute_force, BruteForceParameters{}};
  Decisions made{std::vector<char>(scene.rays.size() * scene.discs.size())};
  made.seconds = sim::run(problem, brute_force, {.count = false, .engine = engine}).seconds.total();
  for (const sim::Pair& pair : sim::run(problem, brute_force, {.count = false, .pairs = true, .engine = engine}).pairs)
    made.hits[pair.ray * scene.discs.size() + pair.disc] = 1;
  return made;
}

}  // namespace

std::vector<AxisPoint> arithmetic_axis(const AxisOptions& options) {
  using Exact = boost::multiprecision::cpp_bin_float_100;
  std::vector<AxisPoint> points;
  for (const PairScene& scene :
       {scene_of("ordinary", 0, 0, options.seed), scene_of("hard", 1000, 1e-6, options.seed)}) {
    const Decisions exact = decisions<Exact>(scene, options.stop);
    double hits = 0;
    for (const char hit : exact.hits) hits += hit;
    const auto add = [&](const char* arithmetic, const Decisions& made) {
      double wrong = 0;
      for (std::size_t i = 0; i < exact.hits.size(); ++i) wrong += made.hits[i] != exact.hits[i] ? 1 : 0;
      points.push_back({.axis = "arithmetic",
                        .setting = fmt::format("{}, {} scene", arithmetic, scene.name),
                        .quantity = "decisions of hits",
                        .error = wrong / hits,
                        .seconds = made.seconds,
                        .work = static_cast<double>(exact.hits.size())});
      constexpr double unseen = 3;  // events that may be missed with 5 % probability
      const double half = wrong > 0 ? 2 * std::sqrt(wrong) : unseen;
      points.back().interval = AxisInterval{std::max(0.0, wrong - half) / hits, (wrong + half) / hits};
    };
    add("float", decisions<float>(scene, options.stop));
    add("float, filtered", decisions_by(scene, Engine::simd));
    add("double", decisions_by(scene, Engine::plain));
    add("exact", exact);
    points.back().interval.reset();  // by definition
  }
  return points;
}

}  // namespace detp::validate
