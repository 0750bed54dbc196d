#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/validate/stopping/execute_until.hpp"
#include "guard.hpp"
#include "types.hpp"

using namespace detp;

namespace {

/// Rays from the caller's function, copied batch by batch.
class CallersRays {
 public:
  CallersRays(detp_next_rays next, void* user, int threads, std::size_t bands)
      : next_(next), user_(user), threads_(threads), bands_(bands) {}

  std::optional<validate::RayBatch> operator()(std::uint64_t wanted) {
    detp_rays rays{};
    rays.size = sizeof(rays);
    double photons = 0;
    validate::RayBatch batch;
    const int answer = next_(user_, wanted, &rays, &photons, &batch.scale);
    if (answer == 1) return std::nullopt;
    if (answer != 0) throw sim::Stopped("the function for the next rays stopped the search", {});
    const sim::RaysView view = c::view_of(&rays);
    c::require_bands("the next rays: estimate.bands", bands_, view);
    require_non_negative("the next rays: number of photons", photons);
    if (view.count == 0 && photons == 0) throw std::invalid_argument("the next rays: there are none, and no photons");
    sim::require_memory("the next rays", static_cast<double>(view.count * sim::bytes_of_ray_in(bands_)));
    rays_.resize(view.count);
    sim::read_rays(view, 0, rays_, threads_);
    sim::read_further_powers(view, 0, view.count, further_);
    batch.rays = sim::PathRays(rays_);
    batch.rays.further = {further_, bands_ - 1};
    batch.rays.photons = view.photons;
    batch.photons = photons > 0 ? photons : static_cast<double>(view.count);
    return batch;
  }

 private:
  detp_next_rays next_;
  void* user_;
  int threads_;
  std::size_t bands_;
  std::vector<sim::Ray> rays_;
  std::vector<double> further_;
};

}  // namespace

extern "C" {

detp_status detp_search(const detp_plan* plan, const detp_rays* rays, detp_scratch* scratch,
                        const detp_search_options* options, detp_found* found, detp_error* error) {
  return c::guarded(error, [&] {
    const detp_plan& one = c::given(plan, "plan");
    detp_scratch& memory = c::given(scratch, "scratch");
    detp_found ours = c::known(found, "found");
    const detp_search_options own = options != nullptr ? c::known(options, "options") : detp_search_options{};
    const sim::RaysView view = c::view_of(rays);
    c::require_bands("found.bands", ours.bands, view);
    c::Watch watch(own.progress, own.user, "searching");
    sim::RunOptions wanted{.count = own.count != 0,
                           .pairs = own.pairs != 0,
                           .standard_error = ours.standard_error != nullptr || ours.upper_bound != nullptr,
                           .stop = watch.token(),
                           .threads = own.threads != 0 ? own.threads : one.plan.threads()};
    if (own.progress != nullptr) wanted.progress = [&](double share) { watch.show("searching", share); };
    memory.has_pairs = false;
    const sim::Outcome& outcome = validate::execute(one.plan, view, memory.memory, wanted);
    memory.discs = one.discs;
    memory.has_pairs = own.pairs != 0 && !outcome.stopped;
    c::copy_results(outcome, one.discs, ours);
    ours.total_hits = outcome.total_hits;
    ours.seconds = outcome.seconds.total();
    ours.reading_seconds = outcome.seconds.prepare;
    ours.build_seconds = outcome.seconds.build;
    ours.counts = c::counts_of(with_bytes_touched(as_expected(outcome.counts), one.plan.candidate(), Engine::simd));
    ours.stopped = outcome.stopped ? 1 : 0;
    c::write_back(found, ours);
    if (outcome.stopped) throw sim::Stopped("the search was stopped", outcome.progress);
  });
}

detp_status detp_pairs(const detp_scratch* scratch, uint64_t* offsets, uint32_t* rays, size_t capacity,
                       detp_error* error) {
  return c::guarded(error, [&] {
    const detp_scratch& memory = c::given(scratch, "scratch");
    c::given(offsets, "offsets");
    if (!memory.has_pairs) throw std::invalid_argument("the scratch has no pairs: search with options.pairs");
    const std::vector<sim::Pair>& pairs = memory.memory.outcome.pairs;
    if (!pairs.empty()) c::given(rays, "rays");
    if (capacity < pairs.size())
      throw std::invalid_argument("there are " + std::to_string(pairs.size()) + " pairs, more than the capacity " +
                                  std::to_string(capacity));
    std::fill(offsets, offsets + memory.discs + 1, std::uint64_t{0});
    for (const sim::Pair& pair : pairs) ++offsets[pair.disc + 1];
    for (std::size_t i = 0; i < memory.discs; ++i) offsets[i + 1] += offsets[i];
    // Pairs are sorted by ray, so each disc's rays ascend. offsets[i] moves to the end of row i, and then back.
    for (const sim::Pair& pair : pairs) rays[offsets[pair.disc]++] = static_cast<std::uint32_t>(pair.ray);
    for (std::size_t i = memory.discs; i > 0; --i) offsets[i] = offsets[i - 1];
    offsets[0] = 0;
  });
}

detp_status detp_scratch_create(detp_scratch** scratch, detp_error* error) {
  return c::guarded(error, [&] { c::given(scratch, "scratch") = new detp_scratch; });
}

void detp_scratch_free(detp_scratch** scratch) {
  if (scratch == nullptr) return;
  delete *scratch;
  *scratch = nullptr;
}

detp_status detp_search_until(const detp_plan* plan, detp_next_rays next, void* next_user, const detp_target* target,
                              detp_progress progress, void* user, detp_estimate* estimate, detp_error* error) {
  return c::guarded(error, [&] {
    const detp_plan& one = c::given(plan, "plan");
    if (next == nullptr) throw std::invalid_argument("next is null");
    const detp_target wanted = c::known(target, "target");
    detp_estimate ours = c::known(estimate, "estimate");
    const validate::ErrorTarget error_target{.error = wanted.noise,
                                             .confidence = wanted.confidence == 0 ? 0.95 : wanted.confidence};
    check(error_target);
    c::Watch watch(progress, user, "searching");
    const std::size_t bands = std::max<std::size_t>(1, ours.bands);
    if (wanted.noise_of > bands)
      throw std::invalid_argument("target.noise_of is " + std::to_string(wanted.noise_of) + ", but there are " +
                                  std::to_string(bands) + " bands");
    const auto of_band = wanted.noise_of == 0 ? validate::BandInQuestion{} : wanted.noise_of - 1;
    CallersRays rays(next, next_user, one.plan.threads(), bands);
    validate::UntilOptions options{.progress = watch.report()};
    if (wanted.most_rays != 0) options.most_rays = wanted.most_rays;
    const auto next_or_stop = [&](std::uint64_t count) {
      if (watch.token().stop_requested()) throw sim::Stopped("the progress function stopped the search", {});
      return rays(count);
    };
    validate::ExecutedUntil found =
        validate::execute_until(one.plan, next_or_stop, one.weights, error_target, options, of_band);
    const validate::UntilResult& result = found.result;
    found.fill_outcome();
    if (!found.bands.empty())
      for (std::size_t band = 0; band < bands; ++band)
        c::copy(found.outcome.band(band).irradiance, ours.irradiance, one.discs, band, bands);
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
}
