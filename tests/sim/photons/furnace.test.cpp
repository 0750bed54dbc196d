#include <doctest/doctest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "detp/sim/scene/scene.hpp"
#include "detp/sim/technique/technique.hpp"

namespace detp::support {

/// Power that reaches the surfaces of one material: sums over photons.
struct SurfaceEnergy {
  double arriving = 0;  ///< once for each time that a photon meets such a surface
  double absorbed = 0;
  double expected = 0;  ///< absorbed, as the material says: arriving, times the share that it absorbs
  double variance = 0;  ///< of `absorbed`, about `expected`
};

/// Where the power of the lights goes: sums over the photons 0 … photons - 1, the same that photon_paths traces.
class EnergyBalance {
 public:
  EnergyBalance(const sim::Scene& scene, std::uint64_t photons, std::uint64_t seed)
      : surfaces(scene.mesh.materials.all.size()), materials_(scene.mesh.materials) {
    const sim::PhotonWalk walk(scene, seed);
    for (std::uint64_t photon = 0; photon < photons; ++photon) {
      const double power = walk.power(photon);
      emitted += power;
      const sim::PathEnd end = walk.follow(photon, *this);
      if (end == sim::PathEnd::left || end == sim::PathEnd::missed) left += power;
      if (end == sim::PathEnd::cut) stopped += power;
    }
  }

  double emitted = 0;
  double left = 0;                      ///< by photons that left the scene
  double stopped = 0;                   ///< by photons that were still on their way after the most pieces
  std::vector<SurfaceEnergy> surfaces;  ///< one for each material

  [[nodiscard]] double absorbed() const {
    double sum = 0;
    for (const SurfaceEnergy& surface : surfaces) sum += surface.absorbed;
    return sum;
  }

  void piece(const sim::Ray&, double) {}

  void met(std::uint32_t triangle, double power, bool is_absorbed) {
    const auto& numbers = materials_.of_triangle;
    const sim::Material& material = materials_.of(triangle);
    const double share = std::clamp(1 - material.diffuse - material.specular - material.glass, 0.0, 1.0);
    SurfaceEnergy& surface = surfaces[numbers.empty() ? 0 : numbers[triangle]];
    surface.arriving += power;
    surface.absorbed += is_absorbed ? power : 0;
    surface.expected += share * power;
    surface.variance += share * (1 - share) * power * power;
  }

 private:
  const sim::Materials& materials_;
};

}  // namespace detp::support

/// Scenes whose light is known in closed form. Irradiance and number of hits of each disc are judged: neither the largest
/// deviation of a family of discs, nor the sum of all squared ones, may be such as chance gives once in 10⁶ times.
using namespace detp::sim;
using detp::Candidate;
using detp::Technique;
using detp::support::EnergyBalance;
using detp::support::SurfaceEnergy;
using std::numbers::pi;

namespace {

constexpr double least_chance = 1e-6;
constexpr double side = 2;  // of the closed box, which is centred at the origin
constexpr double faces = 6 * side * side;

/// The closed box; its walls look inwards, scatter like the material, and emit with radiance 1.
Scene furnace(Material material) {
  material.emitted = 1;
  Scene scene;
  scene.name = "furnace";
  built_in::add_box(scene.mesh, {-1, -1, -1}, {{{side, 0, 0}, {0, side, 0}, {0, 0, side}}}, 0.5);
  for (auto& [a, b, c] : scene.mesh.triangles) std::swap(b, c);
  scene.mesh.materials.all = {material};
  scene.box = {glm::dvec3{-1}, glm::dvec3{1}};
  scene.lights = {{SurfaceLight{}, pi * faces}};
  return scene;
}

/// At random places, wholly inside the box, at random angles.
std::vector<Disc> discs_inside(std::uint64_t count, double radius) {
  std::vector<Disc> discs;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto place = uniform4(11, Stream::tests, i);
    const auto turn = uniform4(11, Stream::tests, i, 1);
    const glm::dvec3 centre = (2.0 * glm::dvec3{place[0], place[1], place[2]} - 1.0) * (1 - radius);
    discs.push_back({centre, uniform_direction(turn[0], turn[1]), radius});
  }
  return discs;
}

/// On the walls, looking inwards, wholly on one wall.
std::vector<Disc> discs_on_walls(std::uint64_t count, double radius) {
  std::vector<Disc> discs;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto place = uniform4(12, Stream::tests, i);
    const int axis = static_cast<int>(i % 3);
    const double sign = i % 2 == 0 ? 1 : -1;
    Disc disc{{}, {}, radius};
    disc.centre = disc.normal = glm::dvec3{0.0};
    disc.centre[axis] = sign;
    disc.normal[axis] = -sign;
    disc.centre[(axis + 1) % 3] = (2 * place[0] - 1) * (1 - radius);
    disc.centre[(axis + 2) % 3] = (2 * place[1] - 1) * (1 - radius);
    discs.push_back(disc);
  }
  return discs;
}

Outcome counted(const std::vector<Ray>& rays, const std::vector<Disc>& discs, bool front_facing = false) {
  const Problem problem = make_problem(rays, discs, front_facing, 2);
  return run(problem, Candidate{Technique::brute_force, detp::BruteForceParameters{}});
}

/// Squared deviations of a family of discs, each over its variance.
class Deviations {
 public:
  void add(double square) {
    sum_ += square;
    largest_ = std::max(largest_, square);
    ++count_;
  }

  /// Half of the budget is for the sum, half is divided over the discs.
  [[nodiscard]] bool explained_by_chance() const {
    const auto chance = [](double degrees, double square) {
      return cdf(complement(boost::math::chi_squared(degrees), square));
    };
    return chance(count_, sum_) > 0.5 * least_chance && chance(1, largest_) > 0.5 * least_chance / count_;
  }

 private:
  double sum_ = 0, largest_ = 0, count_ = 0;
};

/// Whether each disc's hits are binomial with this probability per ray.
bool hits_agree(const std::vector<Ray>& rays, const std::vector<Disc>& discs, double probability,
                bool front_facing = false) {
  const Outcome outcome = counted(rays, discs, front_facing);
  const double expected = probability * static_cast<double>(rays.size());
  Deviations deviations;
  for (const auto hits : outcome.hits)
    deviations.add(std::pow(static_cast<double>(hits) - expected, 2) / (expected * (1 - probability)));
  return deviations.explained_by_chance();
}

/// Whether each disc has this irradiance. Its variance is that of its hits; all rays have the same power.
bool irradiance_agrees(const std::vector<Ray>& rays, const std::vector<Disc>& discs, double irradiance,
                       bool front_facing = false) {
  const Outcome outcome = counted(rays, discs, front_facing);
  Deviations deviations;
  for (std::size_t i = 0; i < discs.size(); ++i)
    deviations.add(std::pow(outcome.irradiance[i] / irradiance - 1, 2) * static_cast<double>(outcome.hits[i]));
  return deviations.explained_by_chance();
}

/// The rays with the cosine law forgotten: from the same points of the walls into all directions alike.
std::vector<Ray> without_cosine(std::vector<Ray> rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Ray& ray = rays[i];
    int axis = 0;
    for (int other = 1; other < 3; ++other)
      if (std::abs(ray.origin[other]) > std::abs(ray.origin[axis])) axis = other;
    const auto random = uniform4(13, Stream::tests, i);
    ray.direction = uniform_direction(random[0], random[1]);
    if (ray.direction[axis] * ray.origin[axis] > 0) ray.direction = -ray.direction;
    ray.length = unbounded;
    for (int other = 0; other < 3; ++other)
      ray.length = std::min(
          ray.length, (std::copysign(1.0, ray.direction[other]) - ray.origin[other]) / ray.direction[other] + 1e-4);
  }
  return rays;
}

/// Floor y = 0 and wall x = 0, both 4 long, that meet in the corner along Z, and a sun that lights both.
Scene corner(const glm::dvec3& sun) {
  Scene scene;
  scene.name = "corner";
  built_in::add_quad(scene.mesh, {{{0, 0, -2}, {0, 0, 2}, {4, 0, 2}, {4, 0, -2}}}, 4);
  built_in::add_quad(scene.mesh, {{{0, 0, -2}, {0, 4, -2}, {0, 4, 2}, {0, 0, 2}}}, 4);
  for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
  scene.mesh.materials.all = {{.diffuse = 0}};
  scene.lights = {{DirectionalLight{sun}}};
  return scene;
}

/// Area of the directional light's beam.
double beam(const Scene& scene) {
  const glm::dvec3 half = 0.5 * scene.box.size();
  return pi * glm::dot(half, half);
}

}  // namespace

TEST_SUITE("statistical") {
  constexpr std::size_t pieces = 1'500'000;
  constexpr double radius = 0.25;
  const double landing = pi * radius * radius / faces;  // share of a face that a disc covers

  TEST_CASE("a closed diffuse box with emitting walls has isotropic uniform light: irradiance and hits of each disc") {
    for (const double albedo : {0.0, 0.5, 0.8}) {
      CAPTURE(albedo);
      const std::vector<Ray> rays = photon_paths(furnace({.diffuse = albedo}), pieces, 1).rays;
      // lines of μ_ℓ: a piece is a chord of the box, and meets both faces of a disc inside
      CHECK(hits_agree(rays, discs_inside(60, radius), 2 * landing));
      CHECK(hits_agree(rays, discs_inside(60, radius), landing, true));
      CHECK(hits_agree(rays, discs_on_walls(60, radius), landing, true));
      const double irradiance = pi / (1 - albedo);
      CHECK(irradiance_agrees(rays, discs_on_walls(60, radius), irradiance));
      CHECK(irradiance_agrees(rays, discs_inside(60, radius), irradiance, true));
    }
  }

  TEST_CASE("mirrors, gloss and a mixture of both give the same furnace") {
    for (const Material& material :
         {Material{.diffuse = 0, .specular = 0.5}, Material{.diffuse = 0, .specular = 0.5, .shininess = 5},
          Material{.diffuse = 0.2, .specular = 0.3, .shininess = 50}}) {
      const std::vector<Ray> rays = photon_paths(furnace(material), pieces, 2).rays;
      CHECK(hits_agree(rays, discs_inside(60, radius), 2 * landing));
      CHECK(irradiance_agrees(rays, discs_on_walls(60, radius), 2 * pi));
    }
  }

  TEST_CASE("controls: an albedo 2 % off, and a forgotten cosine, are found") {
    const std::vector<Ray> off = photon_paths(furnace({.diffuse = 0.49}), pieces, 3).rays;
    CHECK_FALSE(irradiance_agrees(off, discs_on_walls(60, radius), 2 * pi));
    const std::vector<Ray> rays = photon_paths(furnace({.diffuse = 0}), 200'000, 3).rays;
    CHECK(hits_agree(rays, discs_inside(60, radius), 2 * landing));
    CHECK_FALSE(hits_agree(without_cosine(rays), discs_inside(60, radius), 2 * landing));
  }

  TEST_CASE("a directional light gives a disc π d² |cos| over the beam's area") {
    Scene scene = corner({0, 0, -1});
    scene.mesh.triangles.resize(1);  // one triangle, away from the discs
    scene.mesh.positions = {{-9, -9, -9}, {-9, -8, -9}, {-8, -9, -9}};
    scene.box = {glm::dvec3{-10}, glm::dvec3{2}};
    scene.lights = {{DirectionalLight{{1, 2, -2}}}};
    const glm::dvec3 direction = glm::dvec3{1, 2, -2} / 3.0;
    const std::vector<Ray> rays = photon_paths(scene, 400'000, 5).rays;
    Deviations deviations;
    const std::vector<Disc> discs = discs_inside(60, 0.9);
    const Outcome outcome = counted(rays, discs);
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const double cosine = std::abs(glm::dot(discs[i].normal, direction));
      const double expected = pi * 0.81 * cosine / beam(scene) * static_cast<double>(rays.size());
      deviations.add(std::pow(static_cast<double>(outcome.hits[i]) - expected, 2) / expected);
    }
    CHECK(deviations.explained_by_chance());
  }

  TEST_CASE("a concave corner shadows its own discs with first intersections, and not with second ones") {
    Scene scene = corner({-1, -1, 0});
    std::vector<Disc> near;
    for (int i = 0; i < 20; ++i) near.push_back({{0.02 * i, 0, -1.5 + 0.15 * i}, {0, 1, 0}, 0.4});
    const double irradiance = std::sqrt(0.5) / beam(scene);
    CHECK_FALSE(irradiance_agrees(photon_paths(scene, 400'000, 6).rays, near, irradiance));
    scene.overshoot = unbounded;
    const std::vector<Ray> rays = photon_paths(scene, 400'000, 6).rays;
    CHECK(irradiance_agrees(rays, near, irradiance));
    CHECK_FALSE(irradiance_agrees(rays, near, 1.02 * irradiance));
  }

  TEST_CASE("white furnace: surfaces that reflect all light, under an even sky, all see the sky's radiance") {
    for (const Material& white : {Material{.diffuse = 1}, Material{.diffuse = 0.5, .specular = 0.5, .shininess = 20}}) {
      Scene scene = corner({});
      scene.lights = {{EnvironmentLight{}}};
      const auto sees_the_sky = [&](const Material& material) {
        scene.mesh.materials.all = {material};
        std::vector<Disc> discs;
        for (int i = 0; i < 20; ++i) {
          discs.push_back({{0.5 + 0.1 * i, 0, -1 + 0.1 * i}, {0, 1, 0}, 0.4});
          discs.push_back({{0, 0.5 + 0.1 * i, -1 + 0.1 * i}, {1, 0, 0}, 0.4});
        }
        return irradiance_agrees(photon_paths(scene, 1'000'000, 7).rays, discs, 1 / (4 * beam(scene)), true);
      };
      CHECK(sees_the_sky(white));
      CHECK_FALSE(sees_the_sky({.diffuse = 0.9}));
      scene.overshoot = unbounded;  // light from behind comes through sheets without thickness
      CHECK_FALSE(sees_the_sky(white));
    }
  }

  TEST_CASE("a glass ball in a furnace changes nothing outside of it") {
    Scene scene = furnace({.diffuse = 0.5});
    const auto walls = scene.mesh.triangles.size();
    built_in::add_patch(scene.mesh, {32, 16}, [](double u, double v) {
      const double phi = 2 * pi * u;
      const double theta = pi * (1 - v);
      return 0.4 * glm::dvec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    });
    Material wall = scene.mesh.materials.all[0];
    scene.mesh.materials.all = {wall, {.diffuse = 0, .glass = 1, .index = 1.5}};
    scene.mesh.materials.of_triangle.assign(scene.mesh.triangles.size(), 1);
    std::fill_n(scene.mesh.materials.of_triangle.begin(), walls, std::uint16_t{0});
    CHECK(irradiance_agrees(photon_paths(scene, 2 * pieces, 8).rays, discs_on_walls(60, radius), 2 * pi));
    scene.mesh.materials.all[1] = {.diffuse = 0.9};
    CHECK_FALSE(irradiance_agrees(photon_paths(scene, 2 * pieces, 8).rays, discs_on_walls(60, radius), 2 * pi));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("emitted = absorbed + escaped + cut off, and each material absorbs its share") {
    Scene scene = corner({-1, -1, 0});
    scene.mesh.materials = {
        .all = {{.name = "floor", .diffuse = 0.7}, {.name = "wall", .diffuse = 0.2, .specular = 0.2}},
        .of_triangle = {0, 0, 1, 1}};
    scene.lights = {{DirectionalLight{{-1, -1, 0}}, 5}, {PointLight{{1, 1, 0}}, 2}};
    constexpr std::uint64_t photons = 100'000;
    const EnergyBalance balance(scene, photons, 1);
    CHECK(balance.emitted == doctest::Approx(7.0 * photons).epsilon(1e-3));
    CHECK(balance.stopped == 0);
    CHECK(balance.absorbed() + balance.left == doctest::Approx(balance.emitted).epsilon(1e-12));
    REQUIRE(balance.surfaces.size() == 2);
    for (const SurfaceEnergy& surface : balance.surfaces) {
      CHECK(std::abs(surface.absorbed - surface.expected) < 4.5 * std::sqrt(surface.variance));
      CHECK(std::sqrt(surface.variance) < 0.01 * surface.absorbed);
    }
    CHECK(balance.surfaces[0].expected == doctest::Approx(0.3 * balance.surfaces[0].arriving));
    CHECK(balance.surfaces[1].expected == doctest::Approx(0.6 * balance.surfaces[1].arriving));
  }

  TEST_CASE("long paths have all their light, and no photon of them is cut" * doctest::test_suite("long")) {
    for (const auto& [bound_albedo, photons] :
         {std::pair{0.5, 3000.0}, {0.99, 1000.0}, {0.999, 1000.0}, {0.9999, 200.0}}) {
      const double albedo = bound_albedo;
      CAPTURE(albedo);
      const TracedPaths paths =
          photon_paths(furnace({.diffuse = albedo}), static_cast<std::size_t>(photons / (1 - albedo)), 5);
      double irradiance = 0;  // mean over the walls
      for (const Ray& ray : paths.rays) irradiance += ray.power / faces;
      const double error = 1 / std::sqrt(static_cast<double>(paths.photon_count));
      CHECK(std::abs(irradiance * (1 - albedo) / pi - 1) < 4.5 * error);
      CHECK(paths.light.photons == std::array<std::uint64_t, path_ends>{paths.photon_count, 0, 0, 0});
      CHECK(paths.light.landings == paths.rays.size());
      CHECK(paths.light.share(PathEnd::absorbed) == 1);
    }
  }

  TEST_CASE("light that leaves, misses or is cut is counted as such") {
    Scene out = furnace({.diffuse = 0.5});
    for (auto& [a, b, c] : out.mesh.triangles) std::swap(b, c);
    const LightLedger light = photon_paths(out, 1000, 1).light;
    CHECK(light.share(PathEnd::missed) == 1);
    CHECK(light.landings == 0);
    Scene open = furnace({.diffuse = 0.5});
    open.mesh.triangles.resize(open.mesh.triangles.size() / 2);
    const LightLedger some = photon_paths(open, 1000, 1).light;
    CHECK(some.share(PathEnd::left) > 0.05);
    CHECK(some.share(PathEnd::missed) > 0.05);
    CHECK(some.share(PathEnd::left) + some.share(PathEnd::missed) + some.share(PathEnd::absorbed) ==
          doctest::Approx(1).epsilon(1e-12));
    const LightLedger endless = photon_paths(furnace({.diffuse = 1}), 1000, 1).light;
    CHECK(endless.photons == std::array<std::uint64_t, path_ends>{0, 0, 0, 1});
    CHECK(endless.landings == PhotonWalk::most_pieces);
  }

  TEST_CASE("a mirror box keeps all light until it is cut off; with 10 % loss the walls absorb all of it") {
    Scene scene = furnace({.diffuse = 0, .specular = 1});
    const EnergyBalance kept(scene, 2, 1);
    CHECK(kept.stopped == kept.emitted);
    CHECK(kept.absorbed() == 0);
    scene.mesh.materials.all[0].specular = 0.9;
    const EnergyBalance lost(scene, 3000, 1);
    CHECK(lost.absorbed() == doctest::Approx(lost.emitted).epsilon(1e-12));
    CHECK(lost.left == 0);
  }
}
