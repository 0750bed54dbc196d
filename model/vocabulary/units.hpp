#pragma once

/// Strong types for the numbers that are easily swapped. All lengths are in scene units.
namespace detp {

/// d: radius of the disc around an irradiance sample, length > 0.
struct DiscRadius {
  double value;
};

/// r₀: radius of the outermost sphere S₀, which holds every disc whole, length > 0.
struct SphereRadius {
  double value;
};

/// Q: radius of a sphere of the cache over the radius of the next larger one, in (0, 1).
struct RadiusRatio {
  double value;
};

}  // namespace detp
