#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "detp/sim/scene/light.hpp"

namespace detp::sim {

/// How a photon's path ended.
enum class PathEnd : std::uint8_t {
  absorbed,  ///< by a surface
  left,      ///< the scene
  missed,    ///< it left the scene without meeting any surface
  cut        ///< it was longer than PhotonWalk::most_pieces
};
inline constexpr std::size_t path_ends = 4;

/// Where the light of one band went, in the unit of LightLedger::power.
struct BandLedger {
  double emitted = 0;
  double deposited = 0;  ///< on surfaces, added up landing by landing
  double left = 0;       ///< the scene
  double cut = 0;

  void operator+=(const BandLedger& other) {
    emitted += other.emitted;
    deposited += other.deposited;
    left += other.left;
    cut += other.cut;
  }
};

/// Where the light of all photons went.
struct LightLedger {
  std::array<std::uint64_t, path_ends> photons = {};  ///< by PathEnd
  std::array<double, path_ends> power = {};           ///< by PathEnd; in proportion to the flux of the lights
  std::uint64_t landings = 0;                         ///< meetings of photons and surfaces
  std::array<BandLedger, 3> bands = {};               ///< of red, green and blue; 0 of photons with one power

  void add(PathEnd end, double of_photon) {
    ++photons[static_cast<std::size_t>(end)];
    power[static_cast<std::size_t>(end)] += of_photon;
  }
  void operator+=(const LightLedger& other) {
    for (std::size_t i = 0; i < path_ends; ++i) {
      photons[i] += other.photons[i];
      power[i] += other.power[i];
    }
    landings += other.landings;
    for (std::size_t band = 0; band < bands.size(); ++band) bands[band] += other.bands[band];
  }
  [[nodiscard]] std::uint64_t all_photons() const { return photons[0] + photons[1] + photons[2] + photons[3]; }
  /// Of all power; 0 without any.
  [[nodiscard]] double share(PathEnd end) const {
    const double all = (power[0] + power[1]) + (power[2] + power[3]);
    return all > 0 ? power[static_cast<std::size_t>(end)] / all : 0;
  }
};

// Where the light of photon paths went, in words.

/// ", 38 % left the scene, 2 % was cut"; empty if at most a hundredth of the light did.
[[nodiscard]] std::string lost_light(const LightLedger& light);

/// That more than a hundredth of the light of emitting surfaces met no surface, or that some was cut, and why that may be.
[[nodiscard]] std::vector<std::string> light_warnings(const LightLedger& light, const std::vector<Light>& lights);

}  // namespace detp::sim
