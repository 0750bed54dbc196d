#include "light_ledger.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "photon_walk.hpp"

namespace detp::sim {
namespace {

constexpr double hardly_any = 0.01;

std::string percent(double share) { return fmt::format("{:.{}g} %", 100 * share, share > 0.1 ? 3 : 2); }

}  // namespace

std::string lost_light(const LightLedger& light) {
  using enum PathEnd;
  const double gone = light.share(left) + light.share(missed);
  std::string text;
  if (gone > hardly_any) text += fmt::format(", {} left the scene", percent(gone));
  if (light.share(cut) > hardly_any) text += fmt::format(", {} was cut", percent(light.share(cut)));
  return text;
}

std::vector<std::string> light_warnings(const LightLedger& light, const std::vector<Light>& lights) {
  std::vector<std::string> warnings;
  const bool surfaces_emit =
      std::ranges::any_of(lights, [](const Light& one) { return kind_of(one) == LightKind::surface; });
  if (const double share = light.share(PathEnd::missed); surfaces_emit && share > hardly_any)
    warnings.push_back(fmt::format(
        "{} of the light leaves the scene without meeting a surface: a surface emits on its front, from which its "
        "corners run anticlockwise; do emitters face outwards?",
        percent(share)));
  if (const std::uint64_t photons = light.photons[static_cast<std::size_t>(PathEnd::cut)]; photons > 0)
    warnings.push_back(fmt::format(
        "the paths of {} photons, {} of the light, were cut after {} pieces: surfaces absorb nearly nothing", photons,
        percent(light.share(PathEnd::cut)), PhotonWalk::most_pieces));
  return warnings;
}

}  // namespace detp::sim
