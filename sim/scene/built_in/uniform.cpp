#include "built_in.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::sim::built_in {

Sample uniform_sample(std::size_t number, std::uint64_t seed) {
  const auto place = uniform4(seed, Stream::samples, number);
  const auto turn = uniform4(seed, Stream::samples, number, 1);
  return {.position = {2 * place[0] - 1, 2 * place[1] - 1, 2 * place[2] - 1},
          .normal = uniform_direction(turn[0], turn[1])};
}

std::vector<Sample> uniform_samples(std::size_t count, std::uint64_t seed, const std::stop_token& stop) {
  StopCheck check(stop, "making samples");
  std::vector<Sample> samples;
  samples.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    samples.push_back(uniform_sample(i, seed));
    check.after(1);
  }
  return samples;
}

}  // namespace detp::sim::built_in
