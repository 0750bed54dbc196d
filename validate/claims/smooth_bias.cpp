#include <cmath>

#include "batches.hpp"
#include "detp/model/accuracy/scene_error.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/technique/technique.hpp"

namespace detp::validate {
namespace {

constexpr double half_side = 1;        // of the square that is lit
constexpr double half_sampled = 0.55;  // of the square with samples: no disc reaches the edge
constexpr double disc_of_bias = 0.4;
constexpr double bend = 2;  // E = 1 + bend r²
constexpr std::size_t most_rays_of_run = 40'000;
constexpr std::size_t runs_in_batch = 6;
constexpr std::size_t samples_in_batch = 100;

double irradiance_at(double x, double y) { return 1 + bend * (x * x + y * y); }

/// Parallel rays onto the square, one in each cell of a lattice: their power gives the irradiance. Stratified places have less
/// noise than independent ones, and the same bias.
std::vector<sim::Ray> parallel_rays(std::size_t cells, std::uint64_t seed) {
  std::vector<sim::Ray> rays;
  rays.reserve(cells * cells);
  const double step = 2 * half_side / static_cast<double>(cells);
  for (std::size_t i = 0; i < cells * cells; ++i) {
    const auto random = sim::uniform4(seed, sim::Stream::tests, i);
    const double x = -half_side + step * (static_cast<double>(i % cells) + random[0]);
    const double y = -half_side + step * (static_cast<double>(i / cells) + random[1]);
    rays.push_back(
        {.origin = {x, y, 1}, .direction = {0, 0, -1}, .length = 2, .power = step * step * irradiance_at(x, y)});
  }
  return rays;
}

std::vector<sim::Disc> random_discs(std::uint64_t seed) {
  std::vector<sim::Disc> discs;
  for (std::size_t i = 0; i < samples_in_batch; ++i) {
    const auto random = sim::uniform4(seed, sim::Stream::tests, i);
    discs.push_back(
        {{half_sampled * (2 * random[0] - 1), half_sampled * (2 * random[1] - 1), 0}, {0, 0, 1}, disc_of_bias});
  }
  return discs;
}

/// ⟨E⟩ and ⟨E²⟩ over the square with samples: with a its half side, ⟨r²⟩ = 2a²/3 and ⟨r⁴⟩ = 28a⁴/45.
model::SceneLight light_on_samples() {
  const double square = half_sampled * half_sampled;
  const double second = 2 * square / 3;
  const double fourth = 28 * square * square / 45;
  return {1 + bend * second, 1 + 2 * bend * second + bend * bend * fourth};
}

/// The mean product of the errors of two runs with their own rays: its mean is the squared bias.
double squared_bias(const std::vector<sim::Disc>& discs, std::size_t cells, const Experiment& experiment, int batch) {
  std::vector<double> sums(discs.size());
  std::vector<double> squares(discs.size());
  for (std::size_t run = 0; run < runs_in_batch; ++run) {
    const auto rays = parallel_rays(cells, batch_seed(experiment, 72 + static_cast<int>(run), batch));
    const sim::Outcome outcome =
        sim::run(sim::make_problem(rays, discs), {Technique::brute_force, BruteForceParameters{}}, {.count = false});
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const double error = outcome.irradiance[i] - irradiance_at(discs[i].centre.x, discs[i].centre.y);
      sums[i] += error;
      squares[i] += error * error;
    }
  }
  double product = 0;
  for (std::size_t i = 0; i < discs.size(); ++i) product += sums[i] * sums[i] - squares[i];
  return product / static_cast<double>(discs.size() * runs_in_batch * (runs_in_batch - 1));
}

}  // namespace

Finding smooth_bias_finding(const Experiment& experiment) {
  const sim::Stopwatch clock;
  const auto cells = static_cast<std::size_t>(std::sqrt(lines_per_batch(experiment, most_rays_of_run)));
  const model::SceneLight light = light_on_samples();
  const std::vector<double> batches = for_each_batch(experiment, [&](int batch) {
    return squared_bias(random_discs(batch_seed(experiment, 71, batch)), cells, experiment, batch) / light.mean_square;
  });
  const double laplacian = 4 * bend;
  const model::BiasTerms terms{.fourth = model::bias_of_curvature(light, laplacian * laplacian)};
  return {.id = "accuracy.smooth-bias",
          .quantity = "squared bias of discs of radius 0.4 in parallel light with E = 1 + 2 r², relative",
          .predictions = {{Form::corrected, "our derivation", model::bias_squared(terms, disc_of_bias)}},
          .observed = batch_means(batches),
          .batches = batch_count,
          .tolerance = 0.005,
          .lines = runs_in_batch * cells * cells * batch_count,
          .seconds = clock.seconds()};
}

}  // namespace detp::validate
