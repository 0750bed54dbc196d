#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/validate/stopping/execute_until.hpp"
#include "guard.hpp"
#include "handles.hpp"
#include "progress.hpp"
#include "views.hpp"

using namespace detp;

namespace {

/// Rays from the caller's function, copied batch by batch.
class CallersRays {
 public:
  CallersRays(detp_next_rays next, void* user, int threads) : next_(next), user_(user), threads_(threads) {}

  std::optional<validate::RayBatch> operator()(std::uint64_t wanted) {
    detp_rays rays{};
    rays.size = sizeof(rays);
    double photons = 0;
    validate::RayBatch batch;
    const int answer = next_(user_, wanted, &rays, &photons, &batch.scale);
    if (answer == 1) return std::nullopt;
    if (answer != 0) throw sim::Stopped("the function for the next rays stopped the search", {});
    const sim::RaysView view = c::view_of(&rays);
    require_non_negative("the next rays: number of photons", photons);
    if (view.count == 0 && photons == 0) throw std::invalid_argument("the next rays: there are none, and no photons");
    sim::require_memory("the next rays", static_cast<double>(view.count) * sizeof(sim::Ray));
    rays_.resize(view.count);
    sim::read_rays(view, 0, rays_, threads_);
    batch.rays = sim::PathRays(rays_);
    batch.rays.photons = view.photons;
    batch.photons = photons > 0 ? photons : static_cast<double>(view.count);
    return batch;
  }

 private:
  detp_next_rays next_;
  void* user_;
  int threads_;
  std::vector<sim::Ray> rays_;
};

}  // namespace

extern "C" detp_status detp_search_until(const detp_plan* plan, detp_next_rays next, void* next_user,
                                         const detp_target* target, detp_progress progress, void* user,
                                         detp_estimate* estimate, detp_error* error) {
  return c::guarded(error, [&] {
    const detp_plan& one = c::given(plan, "plan");
    if (next == nullptr) throw std::invalid_argument("next is null");
    const detp_target wanted = c::known(target, "target");
    detp_estimate ours = c::known(estimate, "estimate");
    const validate::ErrorTarget error_target{.error = wanted.noise,
                                             .confidence = wanted.confidence == 0 ? 0.95 : wanted.confidence};
    check(error_target);
    c::Watch watch(progress, user, "searching");
    CallersRays rays(next, next_user, one.plan.threads());
    validate::UntilOptions options{.progress = watch.report()};
    if (wanted.most_rays != 0) options.most_rays = wanted.most_rays;
    const auto next_or_stop = [&](std::uint64_t count) {
      if (watch.token().stop_requested()) throw sim::Stopped("the progress function stopped the search", {});
      return rays(count);
    };
    const validate::ExecutedUntil found =
        validate::execute_until(one.plan, next_or_stop, one.weights, error_target, options);
    const validate::UntilResult& result = found.result;
    if (ours.irradiance != nullptr && result.irradiance.size() == one.discs)
      std::copy(result.irradiance.begin(), result.irradiance.end(), ours.irradiance);
    ours.noise = result.noise.value;
    ours.noise_low = result.noise.low;
    ours.noise_high = result.noise.high;
    ours.photons = result.photons;
    ours.rays = result.rays;
    ours.reason = result.reason == validate::StopReason::target ? DETP_REACHED
                  : result.reason == validate::StopReason::rays ? DETP_NO_MORE_RAYS
                                                                : DETP_ENDED;
    ours.share_bound = result.share_bound.value_or(0);
    c::write_back(estimate, ours);
    if (result.reason == validate::StopReason::time) throw sim::Stopped("the search was stopped", {});
  });
}
