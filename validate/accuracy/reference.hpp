#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/sim/scene/scene.hpp"
#include "error_split.hpp"

/// The irradiance that estimates are compared with.
namespace detp::validate {

enum class ReferenceKind {
  known,     ///< a closed form
  backward,  ///< by backward paths, which blur nothing (sim/reference)
  landings   ///< photons that land on small patches around the samples, where backward paths miss light
};

[[nodiscard]] std::string_view name(ReferenceKind kind);

struct Reference {
  std::string scene;
  ReferenceKind kind = ReferenceKind::known;
  std::vector<sim::Sample> samples;  ///< spread by area over the triangles
  std::vector<double> irradiance;
  std::vector<double> variance;
  std::uint64_t paths = 0;  ///< backward paths of each sample, on each side; or photons
  double seconds = 0;
  bool stopped = false;  ///< by a stop request, or the time limit: the error is larger than asked for

  [[nodiscard]] ReferenceValues values() const { return {irradiance, variance}; }
  /// Root mean square standard error, relative to the root mean square irradiance.
  [[nodiscard]] double error() const;
};

struct ReferenceOptions {
  std::size_t samples = 2000;
  std::uint64_t seed = 1;
  double error = 0.01;      ///< stops at this Reference::error
  double seconds = 60;      ///< or after this time
  double patch_radius = 0;  ///< of landings; 0: an eighth of the mean edge of the triangles
  bool front_facing = false;
  int threads = 0;  ///< 0: all cores
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

/// Throws std::invalid_argument for a scene without triangles or lights, and options out of range; sim::Stopped if a stop request came
/// before each sample had a value.
[[nodiscard]] Reference make_reference(const sim::Scene& scene, const ReferenceOptions& options = {});

}  // namespace detp::validate
