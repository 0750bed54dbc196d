#include "lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::sim {
namespace {

constexpr double even_share = 0.1;  // of the photons, spread evenly over the lights

bool extends(LightKind kind) {
  return kind == LightKind::area || kind == LightKind::surface || kind == LightKind::environment;
}

}  // namespace

Lights::Lights(const Scene& scene) {
  const DefaultFloatingPoint mode;
  if (scene.lights.empty()) throw std::invalid_argument("photon paths need a light; " + scene.name + " has none");
  double flux = 0;
  double shining = 0;
  std::vector<Emitter> emitters;
  for (const Light& light : scene.lights) {
    require_non_negative("flux of a light", light.flux);
    if (std::fpclassify(light.flux) == FP_SUBNORMAL)
      throw std::invalid_argument(fmt::format("flux of a light must be 0 or at least {:.4g} (got {:.4g})",
                                              std::numeric_limits<double>::min(), light.flux));
    emitters.push_back(emitter_of(light, scene));
    flux += light.flux;
    shining += light.flux > 0 ? 1 : 0;
  }
  require_positive("flux of all lights", flux);
  double sum = 0;
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    const double own = scene.lights[i].flux;
    if (own == 0) continue;
    const double probability = shining == 1 ? 1 : (1 - even_share) * own / flux + even_share / shining;
    shares_.push_back({std::move(emitters[i]), sum += probability, own / probability, extends(kind_of(scene.lights[i])),
                       kind_of(scene.lights[i]) == LightKind::surface});
  }
}

const Lights::Share& Lights::share_of(std::uint64_t photon) const {
  return *std::upper_bound(shares_.begin(), shares_.end() - 1, van_der_corput(photon),
                           [](double number, const Share& share) { return number < share.up_to; });
}

EmittedPhoton Lights::photon(std::uint64_t photon, const std::array<double, 4>& random) const {
  const Share& share = share_of(photon);
  return {share.emitter(random), share.power};
}

}  // namespace detp::sim
