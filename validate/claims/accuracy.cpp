#include <numbers>
#include <span>

#include "batches.hpp"
#include "detp/model/accuracy/scene_error.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/validate/accuracy/replicates.hpp"
#include "experiments.hpp"

/// Errors over @furnace, whose irradiance E is known and even.
namespace detp::validate {
namespace {

constexpr double irradiance = 2 * std::numbers::pi;
constexpr double flux = 6 * std::numbers::pi;
constexpr double reflected = 0.5;
constexpr double walls = 6;
constexpr double room_area = 6;
constexpr double wall_triangle_area = 1.0 / 512;  // 16 by 16 cells on each wall
constexpr std::size_t rays_of_each_run = 25'000;
constexpr std::size_t runs_of_each_batch = 6;
constexpr std::size_t samples_of_each_batch = 600;
constexpr std::size_t strip_samples_of_each_batch = 2400;
constexpr double noise_radius = 0.05;
constexpr double bias_radius = 0.1;
constexpr double clumping_radius = 0.25;
// Tolerances: 5 %, or what 32 batches can decide where few discs are independent, also for small workloads.
constexpr double few_patches = 0.08;
constexpr double few_rays = 0.1;

/// A point of a wall: u along one edge, v along the other, both from 0 to 1.
sim::Sample on_wall(int wall, double u, double v) {
  const int axis = wall / 2;
  const double side = wall % 2;
  sim::Sample sample;
  sample.position[axis] = side;
  sample.position[(axis + 1) % 3] = u;
  sample.position[(axis + 2) % 3] = v;
  sample.normal = glm::dvec3(0.0);
  sample.normal[axis] = 1 - 2 * side;
  return sample;
}

/// At random on the walls, `from_u` and `from_v` away from the edges; stratified along u.
std::vector<sim::Sample> samples_on_walls(std::size_t count, double from_u, double from_v, std::uint64_t seed) {
  std::vector<sim::Sample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = sim::uniform4(seed, sim::Stream::tests, i);
    const double u = (static_cast<double>(i) + place[0]) / static_cast<double>(count);
    const int wall = static_cast<int>(6 * place[2]);
    samples.push_back(on_wall(wall, from_u + (1 - 2 * from_u) * u, from_v + (1 - 2 * from_v) * place[1]));
  }
  return samples;
}

/// The numbers that a batch finds.
struct Errors {
  enum : std::size_t {
    disc_noise,      ///< variance of discs away from edges, over E²
    triangle_noise,  ///< the same of triangle hits
    edge_bias,       ///< squared bias of discs near two edges, over E²
    clumping,        ///< Σ m²/Σ m of six discs, m the pieces of a photon that cross a disc
    photon_power     ///< mean
  };
};

using Runs = std::vector<std::vector<double>>;

double noise_of(const Runs& runs) {
  double sum = 0;
  for (std::size_t i = 0; i < runs[0].size(); ++i) {
    double mean = 0;
    double squares = 0;
    for (const auto& run : runs) mean += run[i] / runs_of_each_batch;
    for (const auto& run : runs) squares += (run[i] - mean) * (run[i] - mean);
    sum += squares / (runs_of_each_batch - 1);
  }
  return sum / static_cast<double>(runs[0].size()) / (irradiance * irradiance);
}

/// The mean product of the errors of two independent runs: its mean is the squared bias.
double bias_of(const Runs& runs) {
  double sum = 0;
  for (std::size_t i = 0; i < runs[0].size(); ++i) {
    double errors = 0;
    double squares = 0;
    for (const auto& run : runs) {
      errors += run[i] - irradiance;
      squares += (run[i] - irradiance) * (run[i] - irradiance);
    }
    sum += (errors * errors - squares) / (runs_of_each_batch * (runs_of_each_batch - 1));
  }
  return sum / static_cast<double>(runs[0].size()) / (irradiance * irradiance);
}

double clumping_of(const sim::Paths& paths) {
  std::vector<sim::Sample> middles;
  for (int wall = 0; wall < 6; ++wall) middles.push_back(on_wall(wall, 0.5, 0.5));
  const auto discs = discs_at(middles, clumping_radius);
  const sim::Outcome outcome =
      sim::run(sim::make_problem(paths, discs), {Technique::brute_force, BruteForceParameters{}},
               {.count = false, .pairs = true});
  double squares = 0;
  std::vector<double> pieces(middles.size());
  std::uint64_t photon = 0;
  const auto close = [&] {
    for (double& count : pieces) {
      squares += count * count;
      count = 0;
    }
  };
  for (const sim::Pair& pair : outcome.pairs) {
    if (paths.photons[pair.ray] != photon) close();
    photon = paths.photons[pair.ray];
    ++pieces[pair.disc];
  }
  close();
  return squares / static_cast<double>(outcome.pairs.size());
}

std::vector<double> errors_of_batch(const Experiment& experiment, ReplicateMaker& maker, std::size_t rays, int batch) {
  const auto inside = samples_on_walls(samples_of_each_batch, 0.15, 0.15, batch_seed(experiment, 61, batch));
  const auto strip = samples_on_walls(strip_samples_of_each_batch, 0, 0.25, batch_seed(experiment, 62, batch));
  Runs discs;
  Runs triangles;
  Runs edges;
  double pieces = 0;
  double power = 0;
  for (std::size_t run = 0; run < runs_of_each_batch; ++run) {
    const sim::Paths paths = maker.trace(rays, batch_seed(experiment, 63 + static_cast<int>(run), batch), 0);
    using enum sim::Estimator;
    discs.push_back(maker.estimate(paths, inside, {.estimator = disc, .radius = noise_radius}).irradiance);
    triangles.push_back(maker.estimate(paths, inside, {.estimator = triangle_hits}).irradiance);
    edges.push_back(maker.estimate(paths, strip, {.estimator = disc, .radius = bias_radius}).irradiance);
    pieces += clumping_of(paths) / runs_of_each_batch;
    power += flux / static_cast<double>(paths.photon_count) / runs_of_each_batch;
  }
  return {noise_of(discs), noise_of(triangles), bias_of(edges), pieces, power};
}

}  // namespace

std::vector<Finding> accuracy_findings(const Experiment& experiment) {
  const sim::Stopwatch clock;
  const std::size_t rays = lines_per_batch(experiment, rays_of_each_run);
  sim::Scene furnace = sim::open_scene({.name = "@furnace", .samples = {}});
  ReplicateMaker maker(furnace, false, 1, experiment.stop);
  BatchNumbers batches;
  for (int batch = 0; batch < batch_count; ++batch) {
    if (experiment.stop.stop_requested()) return {};
    batches.push_back(errors_of_batch(experiment, maker, rays, batch));
  }
  const model::SceneLight light{irradiance, irradiance * irradiance};
  const double power = mean_of(batches, Errors::photon_power).mean;
  const auto clumping = [](double radius) { return model::room_clumping(reflected, radius, room_area, walls); };
  const double strip_area = 0.5;
  std::vector<Finding> findings;
  const auto add = [&](std::string id, std::string quantity, double predicted, std::size_t found, double tolerance) {
    for (Finding& one : completed({{.id = std::move(id),
                        .quantity = std::move(quantity),
                        .predictions = {{Form::corrected, "our derivation", predicted}},
                        .observed = mean_of(batches, found)}},
                                  {.tolerance = tolerance, .lines = runs_of_each_batch * rays, .clock = clock}))
      findings.push_back(std::move(one));
  };
  add("accuracy.disc-noise", "variance of discs of radius 0.05 in @furnace, over the squared irradiance",
      model::disc_noise_squared(light, power, noise_radius, clumping(noise_radius)), Errors::disc_noise, 0.05);
  add("accuracy.triangle-noise", "variance of triangle hits in @furnace, over the squared irradiance",
      model::triangle_noise_squared(light, power, wall_triangle_area), Errors::triangle_noise, few_patches);
  add("accuracy.edge-bias", "squared bias of discs of radius 0.1 in strips between two edges of @furnace, relative",
      model::bias_squared({.linear = model::bias_of_edges(1, strip_area)}, bias_radius), Errors::edge_bias, few_rays);
  add("accuracy.clumping", "sum of m² over sum of m, m the pieces of a photon on a disc of radius 0.25 in @furnace",
      clumping(clumping_radius), Errors::clumping, 0.01);
  findings.push_back(smooth_bias_finding(experiment));
  return findings;
}

double accuracy_work(const Experiment& experiment) {
  constexpr double work_of_a_ray = 64;  // tracing, mostly
  return work_of_a_ray *
         static_cast<double>(runs_of_each_batch * lines_per_batch(experiment, rays_of_each_run) * batch_count);
}

}  // namespace detp::validate
