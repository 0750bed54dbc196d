// Makes notebooks-data/bands.csv: what powers in further bands add to the time of a search.
//
//   cmake --build build --target band_times && build/band_times > notebooks-data/bands.csv
//
// Box trees on one thread, powers drawn at random. Seconds are processor time from discs and rays in memory to irradiance in memory, the
// shortest of 15 runs, those with different numbers of bands one after the other. The first four workloads are those that band_seconds
// (built_in_costs.hpp) was fitted to. Takes about five minutes.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/job/job.hpp"

namespace {

using namespace detp;

struct Timed {
  std::string scene;
  std::vector<sim::Disc> discs;
  sim::Paths paths;
  std::uint64_t photons = 0;
};

constexpr std::array band_numbers{1, 3, 8, 31};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Timed on_cube_faces(std::size_t rays, std::size_t discs, double radius) {
  Timed one{"cube faces", sim::uniform_discs(sim::Body::cube, 2, discs, radius, 3), {}, rays};
  one.paths.rays = sim::LineField(sim::enclosing_sphere(one.discs), 4).lines(0, rays);
  return one;
}

Timed in_scene(const std::string& scene, double rays, double radius, sim::Field field) {
  validate::JobRequest request;
  request.scene = scene;
  request.rays = rays;
  request.disc_radius = validate::Length{radius, true};
  request.field = field;
  const validate::Job job = validate::make_job(request);
  Timed one{scene, job.discs, {}, job.independent_photons()};
  for (std::size_t ray = 0; ray < job.rays.size(); ++ray)
    one.paths.add(job.paths(), ray, job.photons.empty() ? ray : job.photons[ray]);
  return one;
}

/// With random powers in so many bands.
sim::Paths with_bands(sim::Paths paths, std::size_t bands) {
  paths.further_bands = bands - 1;
  for (std::size_t ray = 0; ray < paths.rays.size(); ++ray)
    for (std::size_t band = 0; band < bands; ++band) {
      const double power = sim::uniform4(5 + band, sim::Stream::tests, ray)[0];
      if (band == 0)
        paths.rays[ray].power = power;
      else
        paths.further.push_back(power);
    }
  return paths;
}

void measure(const Timed& workload, bool errors, bool fitted, const CostTable& costs) {
  std::vector<sim::Paths> all;
  for (const int bands : band_numbers) all.push_back(with_bands(workload.paths, static_cast<std::size_t>(bands)));
  std::vector<double> best(all.size(), HUGE_VAL);
  double hits = 0;
  constexpr int rounds = 15;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double before = processor_seconds();
      const sim::Problem problem = sim::make_problem(all[i], workload.discs);
      const sim::Outcome found = sim::run(problem, {Technique::box_tree, BoxTreeParameters{8, 16}},
                                          {.count = false, .standard_error = errors});
      best[i] = std::min(best[i], processor_seconds() - before);
      hits = static_cast<double>(found.total_hits);
    }
  const bool numbered = !workload.paths.photons.empty();
  for (std::size_t i = 0; i < all.size(); ++i)
    fmt::print("{},{},{},{:.4g},{},{},{},{},{:.0f},{},{:.4g},{:.4g}\n", workload.scene, workload.paths.rays.size(),
               workload.discs.size(), workload.discs.front().radius, workload.photons, numbered ? "yes" : "no",
               errors ? "yes" : "no", fitted ? "yes" : "no", hits, band_numbers[i], best[i],
               1e9 * costs[Technique::box_tree].disc_test);
}

}  // namespace

int main() {
  const CostTable costs = validate::costs_in_use({}).simd;
  fmt::print("scene,rays,discs,disc_radius,photons,numbered,standard_error,fitted,hits,bands,seconds,disc_test_ns\n");
  const std::array fitted{on_cube_faces(800'000, 60'000, 0.004), on_cube_faces(200'000, 100'000, 0.02),
                          on_cube_faces(1'000'000, 2'000, 0.03), on_cube_faces(100'000, 20'000, 0.02)};
  const std::array others{in_scene("@cornell", 300'000, 0.01, sim::Field::photons),
                          in_scene("@tree", 200'000, 0.01, sim::Field::isotropic),
                          in_scene("@interior", 200'000, 0.005, sim::Field::photons),
                          in_scene("@courtyard", 100'000, 0.01, sim::Field::isotropic),
                          in_scene("@caustic", 500'000, 0.02, sim::Field::photons)};
  for (const bool errors : {false, true}) {
    for (const Timed& one : fitted) measure(one, errors, true, costs);
    for (const Timed& one : others) measure(one, errors, false, costs);
  }
}
