#pragma once

/// Strong types for numbers that are easily confused. All lengths are in scene units.
namespace detp {

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
