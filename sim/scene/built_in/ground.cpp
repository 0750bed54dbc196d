#include "ground.hpp"

#include <cmath>

#include "detp/sim/geometry/random.hpp"
#include "mesh_pieces.hpp"

namespace detp::sim::built_in {
namespace {

/// Random height at each lattice point (integer coordinates), uniform in [-1/2, 1/2).
double lattice_noise(std::uint64_t seed, double x, double z) {
  const auto place = [](double coordinate) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(coordinate));
  };
  return uniform4(seed, Stream::scene, place(x), place(z))[0] - 0.5;
}

/// Interpolates the lattice noise with a cubic; never exceeds the highest of the four lattice points around.
double smooth_noise(std::uint64_t seed, double x, double z) {
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double left = std::floor(x);
  const double back = std::floor(z);
  const double u = ease(x - left);
  const double v = ease(z - back);
  return (1 - v) * ((1 - u) * lattice_noise(seed, left, back) + u * lattice_noise(seed, left + 1, back)) +
         v * ((1 - u) * lattice_noise(seed, left, back + 1) + u * lattice_noise(seed, left + 1, back + 1));
}

}  // namespace

double Ground::height(double x, double z) const {
  const double hills = smooth_noise(seed, x / hill_size, z / hill_size);
  const double bumps = smooth_noise(seed + 1, 3 * x / hill_size, 3 * z / hill_size);
  return relief * (0.8 * hills + 0.2 * bumps);
}

void add_ground(Mesh& mesh, const Ground& ground) {
  add_patch(mesh, {ground.cells, ground.cells}, [&ground](double u, double v) {
    const double z = (u - 0.5) * ground.side;
    const double x = (v - 0.5) * ground.side;
    return glm::dvec3{x, ground.height(x, z), z};
  });
}

}  // namespace detp::sim::built_in
