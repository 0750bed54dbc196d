#include "plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "detp/sim/geometry/directions.hpp"
#include "mesh_pieces.hpp"
#include "random_sequence.hpp"

namespace detp::sim::built_in {
namespace {

constexpr glm::dvec3 upwards{0, 1, 0};

/// The state of a limb at its foot.
struct Shoot {
  glm::dvec3 foot;
  glm::dvec3 direction;
  double length;
  double radius;
};

glm::dvec3 any_direction(RandomSequence& random) {
  const double u = random.between(0, 1);
  return uniform_direction(u, random.between(0, 1));
}

/// Length L of the pieces of a tube such that the mean length of its edges is `edge`. A tube has equally many edges
/// around it (length a = `around`), along it (L) and across a piece (√(L² + a²)), so a + L + √(L² + a²) = 3 edge.
double piece_length(double edge, double around) {
  const double rest = 3 * edge - around;
  return (rest * rest - around * around) / (2 * rest);
}

/// A limb's radius, relative to its foot; it decreases to 0.35 at the end.
double taper(double share) { return 1 - 0.65 * share; }

Limb grow_limb(const Shoot& shoot, double lift, double wobble, double edge, RandomSequence& random) {
  Limb limb;
  const double radius = shoot.radius * taper(0.5);
  limb.sides = std::max(3, static_cast<int>(std::lround(2 * std::numbers::pi * radius / edge)));
  const double around = 2 * radius * std::sin(std::numbers::pi / limb.sides);
  const int pieces = std::max(2, static_cast<int>(std::lround(shoot.length / piece_length(edge, around))));
  glm::dvec3 point = shoot.foot;
  glm::dvec3 direction = shoot.direction;
  for (int i = 0; i <= pieces; ++i) {
    limb.path.push_back(point);
    limb.radii.push_back(shoot.radius * taper(static_cast<double>(i) / pieces));
    direction = glm::normalize(direction + lift / pieces * upwards + wobble * any_direction(random));
    point += shoot.length / pieces * direction;
  }
  return limb;
}

double length_of(const Limb& limb) {
  return static_cast<double>(limb.path.size() - 1) * glm::length(limb.path[1] - limb.path[0]);
}

/// Shoot number i on a limb. Each shoot is turned from the previous one by the golden angle, as on most plants,
/// and by up to 0.3 radians at random.
Shoot shoot_of(const Limb& limb, const Generation& generation, int i, double first_turn, RandomSequence& random) {
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  const double order = generation.limbs == 1 ? 1.0 : static_cast<double>(i) / (generation.limbs - 1);
  const double share = generation.from + order * (generation.to - generation.from);
  const std::size_t last = limb.path.size() - 1;
  const double place = share * static_cast<double>(last);
  const std::size_t before = std::min(static_cast<std::size_t>(place), last - 1);
  const glm::dvec3 piece = limb.path[before + 1] - limb.path[before];
  const glm::dvec3 axis = glm::normalize(piece);
  const auto [first, second] = basis_around(axis);
  const double turn = first_turn + golden_angle * i + random.between(-0.3, 0.3);
  const double angle = generation.angle * random.between(0.85, 1.15);
  return {
      .foot = limb.path[before] + (place - static_cast<double>(before)) * piece,
      .direction = std::cos(angle) * axis + std::sin(angle) * (std::cos(turn) * first + std::sin(turn) * second),
      .length = length_of(limb) * generation.length * (1 - generation.shortening * order) * random.between(0.8, 1.2),
      .radius = limb.radii[before] * generation.thickness};
}

/// Adds a leaf on a twig: chooses its base, its direction and a tilted upward direction.
void add_leaf(Mesh& mesh, const Limb& twig, const Foliage& foliage, RandomSequence& random) {
  const std::size_t last = twig.path.size() - 1;
  const double place = random.between(0.15, 1) * static_cast<double>(last);
  const std::size_t before = std::min(static_cast<std::size_t>(place), last - 1);
  const glm::dvec3 piece = twig.path[before + 1] - twig.path[before];
  const glm::dvec3 base = twig.path[before] + (place - static_cast<double>(before)) * piece;
  const glm::dvec3 along = glm::normalize(0.5 * glm::normalize(piece) + any_direction(random) * glm::dvec3{1, 0.5, 1});
  const glm::dvec3 across = glm::normalize(glm::cross(upwards + 0.6 * any_direction(random), along));
  const double size = random.between(0.8, 1.2);
  add_patch(mesh, {2, 1}, [&](double u, double v) {
    return base +
           size * (foliage.length * (u * along - foliage.droop * u * u * upwards) + foliage.width * (v - 0.5) * across);
  });
}

}  // namespace

std::vector<std::vector<Limb>> grow(const Plant& plant) {
  RandomSequence random(plant.seed);
  const Shoot trunk{.foot = plant.foot, .direction = upwards, .length = plant.height, .radius = plant.radius};
  std::vector<std::vector<Limb>> limbs{{grow_limb(trunk, 0, 0.02, plant.edge, random)}};
  for (const Generation& generation : plant.generations) {
    std::vector<Limb> next;
    for (const Limb& limb : limbs.back()) {
      const double first_turn = random.between(0, 2 * std::numbers::pi);
      for (int i = 0; i < generation.limbs; ++i)
        next.push_back(grow_limb(shoot_of(limb, generation, i, first_turn, random), generation.lift, generation.wobble,
                                 plant.edge, random));
    }
    limbs.push_back(std::move(next));
  }
  return limbs;
}

void add_limbs(Mesh& mesh, const std::vector<Limb>& limbs) {
  for (const Limb& limb : limbs)
    add_tube(mesh, {.path = limb.path, .radii = limb.radii, .sides = limb.sides, .tip = true});
}

void add_foliage(Mesh& mesh, const std::vector<Limb>& twigs, const Foliage& foliage) {
  RandomSequence random(foliage.seed);
  for (std::size_t i = 0; i < foliage.leaves; ++i) add_leaf(mesh, twigs[i % twigs.size()], foliage, random);
}

}  // namespace detp::sim::built_in
