#include <doctest/doctest.h>
#include <oneapi/tbb/parallel_for.h>

#include <functional>
#include <thread>
#include <vector>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "support/candidates.hpp"
#include "support/machine.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

/// Rays whose power, and so most irradiances, are subnormal numbers.
const std::vector<Ray>& faint_rays() {
  static const std::vector<Ray> all = [] {
    std::vector<Ray> rays = LineField({{0, 0, 0}, 2}, 4).lines(0, 3000);
    for (std::size_t i = 0; i < rays.size(); ++i) rays[i].power = 1e-310 * static_cast<double>(i % 7 + 1);
    return rays;
  }();
  return all;
}

/// The irradiances of a run, of a searcher and of a stream.
std::vector<double> irradiances(const Candidate& candidate) {
  const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 500, 0.2, 3);
  const Problem problem = make_problem(faint_rays(), discs, false, 2);
  std::vector<double> all = run(problem, candidate, {.threads = 2}).irradiance;
  SearchScratch scratch;
  const auto add = [&](const std::vector<double>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(Searcher(discs, candidate).search(faint_rays(), scratch, {.threads = 2}).irradiance);
  add(run_streamed(discs, RaysInMemory(faint_rays()), candidate, {.run = {.threads = 2}, .block = 1000})
          .outcome.irradiance);
  return all;
}

/// What `find` returns on a thread where oneTBB was started, and where it is called, with flushing to zero.
std::vector<double> while_flushing(const std::function<std::vector<double>()>& find) {
  std::vector<double> found;
  std::thread([&] {
    const support::Flushing mode;
    oneapi::tbb::parallel_for(0, 100, [](int) {});
    found = find();
  }).join();
  return found;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a caller that flushes subnormal numbers to zero gets the same bits") {
    for (const Candidate& candidate : support::exact_candidates()) {
      CAPTURE(describe(candidate));
      const std::vector<double> usual = irradiances(candidate);
      bool some_subnormal = false;
      for (const double irradiance : usual) some_subnormal |= std::fpclassify(irradiance) == FP_SUBNORMAL;
      CHECK(some_subnormal);
      CHECK(while_flushing([&] { return irradiances(candidate); }) == usual);
    }
  }

  TEST_CASE("photon paths of a caller that flushes subnormal numbers to zero are the same") {
    const auto powers = [] {
      const Scene scene = open_scene({"@cornell", std::nullopt, 1});
      std::vector<Ray> rays(2000);
      PhotonSource(scene, rays.size(), 1, caster_for(scene)).read(0, rays, {});
      std::vector<double> all;
      for (const Ray& ray : rays)
        for (const double number : {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.length, ray.power})
          all.push_back(number);
      return all;
    };
    CHECK(while_flushing(powers) == powers());
  }
}
