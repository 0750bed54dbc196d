#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/reference/missed_light.hpp"
#include "guard.hpp"
#include "types.hpp"

using namespace detp;

namespace {

/// Their radii do not matter, but a problem has some.
std::vector<sim::Disc> read_samples(const detp_discs* discs) {
  detp_discs ours = c::known(discs, "discs");
  ours.size = sizeof(ours);
  ours.radii = {.data = nullptr, .stride = 0, .type = DETP_DOUBLE, .of_all = 1};
  return sim::read_discs(c::view_of(&ours));
}

}  // namespace

extern "C" {

detp_status detp_gather(const char* scene, const detp_discs* discs, const detp_gather_options* options,
                        detp_gathered* gathered, detp_error* error) {
  return c::guarded(error, [&] {
    detp_gathered ours = c::known(gathered, "gathered");
    const detp_gather_options own = options != nullptr ? c::known(options, "options") : detp_gather_options{};
    const std::vector<sim::Disc> samples = read_samples(discs);
    c::Watch watch(own.progress, own.user, "reading the scene");
    const sim::Scene opened =
        sim::open_scene({.name = &c::given(scene, "scene"), .samples = {}, .rgb = own.rgb != 0}, watch.token());
    sim::RunOptions wanted{.count = false,
                           .standard_error = ours.standard_error != nullptr || ours.upper_bound != nullptr,
                           .stop = watch.token(),
                           .threads = own.threads};
    if (own.progress != nullptr) wanted.progress = [&](double share) { watch.show("following paths", share); };
    const sim::Stopwatch time;
    const sim::Problem problem = sim::make_problem_without_rays(samples, 0, own.front_facing != 0, watch.token());
    const sim::Outcome outcome = sim::estimate(problem,
                                               {.estimator = sim::Estimator::gather,
                                                .scene = &opened,
                                                .paths = own.paths != 0 ? own.paths : sim::paths_by_default,
                                                .seed = own.seed},
                                               wanted);
    sim::MissedShare missed;
    sim::on_threads(sim::thread_count(own.threads), [&] {
      missed = sim::missed_share(opened, nullptr, own.seed, sim::photons_of_share, watch.token());
    });
    c::copy_results(outcome, samples.size(), ours);
    ours.missed_share = missed.share;
    ours.missed_bound = missed.upper_bound;
    ours.seconds = time.seconds();
    ours.stopped = outcome.stopped ? 1 : 0;
    c::write_back(gathered, ours);
    if (outcome.stopped) throw sim::Stopped("the paths were stopped", outcome.progress);
  });
}
}
