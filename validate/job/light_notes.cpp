#include "light_notes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "detp/sim/photons/photon_walk.hpp"

namespace detp::validate {
namespace {

constexpr double hardly_any = 0.01;

std::string percent(double share) { return fmt::format("{:.{}g} %", 100 * share, share > 0.1 ? 3 : 2); }

}  // namespace

std::string lost_light(const sim::LightLedger& light) {
  using enum sim::PathEnd;
  const double gone = light.share(left) + light.share(missed);
  std::string text;
  if (gone > hardly_any) text += fmt::format(", {} left the scene", percent(gone));
  if (light.share(cut) > hardly_any) text += fmt::format(", {} was cut", percent(light.share(cut)));
  return text;
}

std::vector<std::string> light_warnings(const sim::LightLedger& light, const std::vector<sim::Light>& lights) {
  std::vector<std::string> warnings;
  const bool surfaces_emit =
      std::ranges::any_of(lights, [](const sim::Light& one) { return sim::kind_of(one) == sim::LightKind::surface; });
  if (const double share = light.share(sim::PathEnd::missed); surfaces_emit && share > hardly_any)
    warnings.push_back(fmt::format(
        "{} of the light leaves the scene without meeting a surface: a surface emits on its front, from which its "
        "corners run anticlockwise; do emitters face outwards?",
        percent(share)));
  if (const std::uint64_t photons = light.photons[static_cast<std::size_t>(sim::PathEnd::cut)]; photons > 0)
    warnings.push_back(fmt::format(
        "the paths of {} photons, {} of the light, were cut after {} pieces: surfaces absorb nearly nothing", photons,
        percent(light.share(sim::PathEnd::cut)), sim::PhotonWalk::most_pieces));
  return warnings;
}

}  // namespace detp::validate
