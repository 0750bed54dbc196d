#include "disc_summary.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/base/floating_point.hpp"
#include "soundness.hpp"

namespace detp::sim {

DiscSummary summary_of(const DiscSource& discs, const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  require_number("disc", discs.size());
  StopCheck check(stop, "checking discs");
  DiscExtent extent;
  double squares = 0;
  for_each_block(discs, stop, [&](std::uint64_t first, std::span<const Disc> block) {
    const DiscExtent here = extent_of(block);
    if (!here.sound) require_sound(block, check, first);
    extent = joined(extent, here);
    for (const Disc& disc : block) squares += disc.radius * disc.radius;
  });
  const double rms =
      extent.smallest == extent.largest ? extent.largest : std::sqrt(squares / static_cast<double>(discs.size()));
  return {sphere_around(extent), extent.centres, {extent.smallest, extent.largest, rms}};
}

std::vector<Disc> sample_of(const DiscSource& discs, std::uint64_t most, const std::stop_token& stop) {
  const std::uint64_t stride = (discs.size() + most - 1) / most;
  std::vector<Disc> sample;
  sample.reserve(static_cast<std::size_t>(discs.size() / stride + 1));
  for_each_block(discs, stop, [&](std::uint64_t first, std::span<const Disc> block) {
    for (std::uint64_t i = (stride - first % stride) % stride; i < block.size(); i += stride)
      sample.push_back(block[i]);
  });
  return sample;
}

}  // namespace detp::sim
