#include <doctest/doctest.h>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/technique/streamed.hpp"

using namespace detp;
using namespace detp::sim;

TEST_SUITE("identity") {
  TEST_CASE("photon paths that are traced as they are searched bring what they bring in memory") {
    Scene scene = open_scene({.name = "@cornell", .samples = {}});
    std::vector<Disc> discs;
    for (const Sample& sample : scene.samples) discs.push_back({sample.position, sample.normal, 0.02});
    for (const std::size_t count : {3000, 200'000}) {
      const TracedPaths paths = photon_paths(scene, count, 3);
      const RunOptions options{.standard_error = true, .threads = 2};
      const Candidate tree{Technique::box_tree, BoxTreeParameters{}};
      const Outcome all = run(make_problem(paths, discs), tree, options);
      for (const Counting counting : {Counting::ahead, Counting::as_read}) {
        const PhotonSource source(scene, count, 3, caster_for(scene), {}, nullptr, counting);
        const StreamedOutcome streamed = run_streamed(discs, source, tree, {.run = options, .block = 30'000});
        const Outcome& found = streamed.outcome;
        CHECK(found.hits == all.hits);
        CHECK(found.progress.done == paths.rays.size());
        CHECK(found.progress.of == paths.rays.size());
        for (std::size_t disc = 0; disc < discs.size(); ++disc) {
          REQUIRE(found.irradiance[disc] == doctest::Approx(all.irradiance[disc]).epsilon(1e-12));
          REQUIRE(found.upper_bound[disc] == doctest::Approx(all.upper_bound[disc]).epsilon(1e-9));
          if (std::isfinite(all.standard_error[disc]))
            REQUIRE(found.standard_error[disc] == doctest::Approx(all.standard_error[disc]).epsilon(1e-9));
        }
      }
    }
  }
}
