#pragma once

#include <cstdint>
#include <vector>

#include "detp/sim/scene/mesh.hpp"

/// Trees: limbs that bear limbs. The last generation bears leaves.
namespace detp::sim::built_in {

/// How the limbs of one generation grow on the limbs of the previous generation (their parents). The trunk is the first
/// generation.
struct Generation {
  int limbs;          ///< on each parent
  double from, to;    ///< shares of the parent's length between which the limbs sit
  double length;      ///< of the parent's lowest limb, divided by the parent's length
  double shortening;  ///< share by which the topmost limb is shorter than the lowest
  double thickness;   ///< radius at the foot, divided by the parent's radius there
  double angle;       ///< angle to the parent, radians
  double lift;        ///< how far a limb bends towards the sky (negative: the ground) along its length; 1 is about 45°
  double wobble;      ///< random turn of each of its pieces
};

struct Plant {
  glm::dvec3 foot;
  double height;  ///< of the trunk, a length
  double radius;  ///< of the trunk at its foot, a length
  std::vector<Generation> generations;
  double edge;  ///< intended mean edge length of the limbs' triangles
  std::uint64_t seed;
};

struct Limb {
  std::vector<glm::dvec3> path;
  std::vector<double> radii;  ///< one for each point of the path
  int sides = 3;
};

/// The limbs of each generation, the trunk's first.
[[nodiscard]] std::vector<std::vector<Limb>> grow(const Plant& plant);

/// Adds each limb as a tube with a pointed tip.
void add_limbs(Mesh& mesh, const std::vector<Limb>& limbs);

struct Foliage {
  std::size_t leaves;
  double length;  ///< of a leaf, or of a spray of small leaves
  double width;
  double droop;  ///< how far its end hangs down, divided by its length
  std::uint64_t seed;
};

inline constexpr std::size_t triangles_of_a_leaf = 4;

/// Distributes the leaves over the twigs in turn, along the outer 85 % of each twig. Leaves face roughly up.
void add_foliage(Mesh& mesh, const std::vector<Limb>& twigs, const Foliage& foliage);

}  // namespace detp::sim::built_in
