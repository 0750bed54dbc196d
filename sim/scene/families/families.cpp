#include "families.hpp"

#include <array>

namespace detp::sim::families {

std::span<const Family> all_families() {
  static constexpr std::array all{Family{"room", room},       Family{"plant", plant},   Family{"machine", machine},
                                  Family{"terrain", terrain}, Family{"shells", shells}, Family{"details", details}};
  return all;
}

}  // namespace detp::sim::families
