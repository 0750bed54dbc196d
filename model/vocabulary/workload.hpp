#pragma once

#include <array>
#include <vector>

namespace detp {

/// Discs of about the same radius.
struct RadiusClass {
  double radius = 0;  ///< root mean square of their radii, length > 0
  double share = 0;   ///< of all discs, > 0
};

/// Boxes around the discs of samples that follow each other on the Lebesgue curve, in cells of the curve. Means over the
/// cells that hold about as many samples, as polynomials in d: the coefficient k belongs to d^k.
struct NodeBoxes {
  double samples = 0;                           ///< in each, >= 1
  double edges = 0;                             ///< sum of the sides of the box around the centres, length
  std::array<double, 3> surface = {0, 0, 0};    ///< length²
  std::array<double, 3> squares = {0, 0, 0};    ///< sum of the squared sides, length²
  std::array<double, 4> volume = {0, 0, 0, 0};  ///< length³
};

/// n_R rays against n_P discs of radius d inside the sphere S₀.
///
/// The models assume that the rays are lines of the measure μ_ℓ through S₀, and that the samples are uniform over a
/// body of `dimension` (3: a volume, 2: surfaces) that fills the box.
struct Workload {
  double rays = 0;                        ///< n_R, a whole number 1 … 1e18
  double samples = 0;                     ///< n_P, a whole number 1 … 1e18
  double disc_radius = 0;                 ///< d, length > 0
  double sphere_radius = 0;               ///< r₀, length > 0; S₀ contains every disc completely
  std::array<double, 3> box = {0, 0, 0};  ///< sides of the samples' bounding box, lengths >= 0, not all 0
  double dimension = 3;                   ///< D of the sample set, 1 … 3
  /// volume (D = 3) or area (D = 2) that the samples fill; 0: that of the box, or of its faces
  double sample_extent = 0;
  double sample_distance = 0;  ///< mean distance between neighbouring samples, length; 0: computed from the extent
  double path_length = 0;      ///< mean length of the rays inside the box; 0: as for unbounded lines
  double ray_density = 1;      ///< rays that cross small spheres around samples, over that of uniform rays, > 0
  double hit_ratio = 1;        ///< hits of discs, over those of isotropic rays of the same density, > 0
  bool rays_end = false;       ///< some rays end, so tests of them cost more
  bool front_facing = false;   ///< only rays that arrive at a disc's front count as hits
  /// empty: all discs have radius d. Otherwise classes of radii, the largest first; d is the root mean square of all
  std::vector<RadiusClass> radii = {};
  /// empty: samples are uniform over their extent. Otherwise the boxes around them, at least two: those with the most
  /// samples first, those with one sample last
  std::vector<NodeBoxes> nodes = {};
};

/// Throws std::invalid_argument if a number is out of its range, if r₀ or the longest side is not in 1e-90 … 1e90, or
/// if the extent is above 1e270; if radii do not fall from class to class, shares do not add up to 1, or d is not the
/// root mean square, to one in a million; if a value of the boxes around samples or of the central samples is out of
/// its range.
void check(const Workload& workload);

/// The extent that the samples fill: the workload's value if it is set. Otherwise it is the box's volume (D = 3), the
/// area of its faces (D <= 2), or the geometric interpolation of both (D between 2 and 3); a side counts as at least
/// 1e-6 of the longest. Largest relative errors over 10⁶ workloads (tests/model/hard_cases): 4.4e-16 here, 3.4e-16 for
/// sample_distance, 2.8e-16 for enclosing_radius.
[[nodiscard]] double sample_extent(const Workload& workload);

/// Mean distance between neighbouring samples: the workload's value if it is set, else (extent / n_P)^(1/D).
[[nodiscard]] double sample_distance(const Workload& workload);

/// The radius of the largest class; d if all discs have the same radius.
[[nodiscard]] double largest_radius(const Workload& workload);

/// The expected radius of the largest of `discs` >= 1 random discs.
[[nodiscard]] double largest_radius(const Workload& workload, double discs);

/// The same workload with all radii scaled so that their root mean square is `disc_radius`. S₀ grows with the largest.
[[nodiscard]] Workload with_disc_radius(Workload workload, double disc_radius);

/// Whether some rays end: rays_end, or a path length is set.
[[nodiscard]] inline bool some_rays_end(const Workload& workload) {
  return workload.rays_end || workload.path_length > 0;
}

/// The longest side of the samples' box: s.
[[nodiscard]] double scene_side(const Workload& workload);

/// r₀ of the sphere around a cube of side s whose samples carry discs of radius d: s√3/2 + d.
[[nodiscard]] double enclosing_radius(double side, double disc_radius);

/// n_P samples in a cube of side s, or on its faces if dimension is 2.
[[nodiscard]] Workload cube_workload(double rays, double samples, double disc_radius, double side,
                                     double dimension = 3);

// Strong types for numbers that are easily confused. All lengths are in scene units.

/// d: radius of the disc around an irradiance sample, length > 0.
struct DiscRadius {
  double value;
};

/// r₀: radius of the outermost sphere S₀, which contains every disc completely, length > 0.
struct SphereRadius {
  double value;
};

/// Q: radius of a sphere of the cache divided by the radius of the next larger one, in (0, 1).
struct RadiusRatio {
  double value;
};

}  // namespace detp
