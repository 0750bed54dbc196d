#include "light.hpp"

namespace detp::sim {

std::string_view name(LightKind kind) {
  switch (kind) {
    case LightKind::area:
      return "area";
    case LightKind::point:
      return "point";
    case LightKind::spot:
      return "spot";
    case LightKind::directional:
      return "directional";
    case LightKind::environment:
      return "environment";
    case LightKind::surface:
      break;
  }
  return "surface";
}

}  // namespace detp::sim
