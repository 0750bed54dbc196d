#include "curve_sample.hpp"

#include <hwy/cache_control.h>
#include <algorithm>
#include <array>
#include <glm/common.hpp>

#include "detp/sim/base/radix_sort.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::sim {
namespace {

constexpr float cells_a_side = 1U << levels_of_cells;

/// Bit i of a byte at bit 3i.
constexpr auto spread_bytes = [] {
  std::array<std::uint32_t, 256> all{};
  for (std::uint32_t byte = 0; byte < 256; ++byte)
    for (std::uint32_t bit = 0; bit < 8; ++bit) all[byte] |= (byte >> bit & 1) << 3 * bit;
  return all;
}();

/// The place of a point on the curve, as lebesgue_code has it; in floats.
class CurvePlaces {
 public:
  CurvePlaces(const glm::vec3& low, const glm::vec3& high) : low_(low) {
    const glm::vec3 size = high - low;
    const float side = std::max({size.x, size.y, size.z});
    scale_ = side > 0 ? cells_a_side / side : 0;
  }

  [[nodiscard]] std::uint64_t operator()(const glm::vec3& point) const {
    return along(point.x - low_.x) << 2 | along(point.y - low_.y) << 1 | along(point.z - low_.z);
  }

 private:
  [[nodiscard]] std::uint64_t along(float distance) const {
    const auto cell = static_cast<std::uint32_t>(std::min(distance * scale_, cells_a_side - 1));
    return static_cast<std::uint64_t>(spread_bytes[cell >> 8]) << 24 | spread_bytes[cell & 0xff];
  }

  glm::vec3 low_;
  float scale_;
};

}  // namespace

CurveSample curve_sample(std::span<const Disc> discs, std::span<const std::size_t> sample, const Sphere& sphere,
                         const std::stop_token& stop) {
  const double scale = sphere.radius > 0 ? 1 / sphere.radius : 0;
  std::vector<SampledDisc> in_array;
  in_array.reserve(sample.size());
  glm::vec3 low(1);
  glm::vec3 high(-1);
  constexpr std::size_t ahead = 12;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (i + ahead < sample.size()) {  // the discs lie far apart in memory
      hwy::Prefetch(&discs[sample[i + ahead]]);
      hwy::Prefetch(&discs[sample[i + ahead]].normal.y);
    }
    const Disc& disc = discs[sample[i]];
    const glm::vec3 centre((disc.centre - sphere.centre) * scale);
    low = glm::min(low, centre);
    high = glm::max(high, centre);
    in_array.push_back({centre, glm::abs(glm::vec3(disc.normal)), static_cast<std::uint32_t>(sample[i])});
  }
  const CurvePlaces place(low, high);
  std::vector<KeyedIndex> order;
  order.reserve(sample.size());
  for (std::size_t i = 0; i < in_array.size(); ++i)
    order.push_back({place(in_array[i].centre), static_cast<std::uint32_t>(i)});
  radix_sort(order, 3 * levels_of_cells, stop);
  CurveSample sorted{.discs = {}, .keys = {}, .origin = sphere.centre, .unit = sphere.radius};
  sorted.discs.reserve(sample.size());
  sorted.keys.reserve(sample.size());
  for (const KeyedIndex& one : order) {
    sorted.discs.push_back(in_array[one.index]);
    sorted.keys.push_back(one.key);
  }
  return sorted;
}

CurveSample curve_sample(std::span<const Disc> discs, const Sphere& sphere, std::size_t most,
                         const std::stop_token& stop) {
  return curve_sample(discs, stratified_sample(discs.size(), most, 1, Stream::evidence), sphere, stop);
}

}  // namespace detp::sim
