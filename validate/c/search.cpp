#include "counts.hpp"
#include "guard.hpp"
#include "handles.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "views.hpp"

using namespace detp;

extern "C" {

detp_status detp_search(const detp_plan* plan, const detp_rays* rays, detp_scratch* scratch,
                        const detp_search_options* options, detp_found* found, detp_error* error) {
  return c::guarded(error, [&] {
    const detp_plan& one = c::given(plan, "plan");
    detp_scratch& memory = c::given(scratch, "scratch");
    detp_found ours = c::known(found, "found");
    const detp_search_options own = options != nullptr ? c::known(options, "options") : detp_search_options{};
    const sim::RaysView view = c::view_of(rays);
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
}
