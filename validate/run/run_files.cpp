#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/sim/files/writing_check.hpp"
#include "run.hpp"

namespace detp::validate {
namespace {

/// "ray,disc" for each pair. `order`: numbers of the rays in their file; empty if they have the file's order.
void write_pairs(const std::string& path, const JobRun& run, const std::vector<std::uint32_t>& order,
                 const std::stop_token& stop) {
  std::vector<sim::Pair> pairs;
  if (!order.empty()) {
    pairs = run.outcome.pairs;
    for (sim::Pair& pair : pairs) pair.ray = order[pair.ray];
    std::ranges::sort(pairs);
  }
  const std::vector<sim::Pair>& sorted = order.empty() ? run.outcome.pairs : pairs;
  sim::WritingCheck check(path, run.results ? run.results->pairs() : sorted.size(), "pairs", stop);
  sim::OutputFile file(path, stop);
  file.write("ray,disc\n");
  const auto write = [&](const sim::Pair& pair) {
    check.next();
    file.write(fmt::format("{},{}\n", pair.ray, pair.disc));
  };
  if (run.results)
    run.results->for_each_pair(write);
  else
    std::ranges::for_each(sorted, write);
  file.commit();
}

/// Hits and irradiance of each disc; with standard errors and bounds if they were asked for.
void write_per_disc(const std::string& path, const JobRun& run, const Job& job, const std::stop_token& stop) {
  const std::vector<std::uint32_t>& vertices = job.vertices;
  const bool errors = run.results ? run.results->errors() : !run.outcome.standard_error.empty();
  sim::WritingCheck check(path, disc_count(run), "discs", stop);
  sim::OutputFile file(path, stop);
  std::string line = "disc,hits";
  for (const std::string& band : job.bands.empty() ? std::vector<std::string>{""} : job.bands) {
    const std::string name = band.empty() ? "" : "_" + band;
    line += ",irradiance" + name;
    if (errors) line += fmt::format(",standard_error{0},upper_bound{0},standard_error_weak{0}", name);
  }
  file.write(line + (vertices.empty() ? "\n" : ",vertex\n"));
  std::uint64_t disc = 0;
  for_each_disc(run, [&](std::span<const sim::DiscResult> by_band) {
    check.next();
    const auto finite = [](double one) { return std::isfinite(one) ? fmt::format("{}", one) : std::string(); };
    line.clear();
    for (const sim::DiscResult& found : by_band) {
      line += fmt::format(",{}", found.irradiance);
      const bool weak = sim::is_weak(found);
      if (errors)
        line +=
            fmt::format(",{},{},{}", finite(found.standard_error), weak ? finite(found.upper_bound) : "", weak ? 1 : 0);
    }
    const std::string vertex = vertices.empty()                   ? ""
                               : vertices[disc] == sim::no_vertex ? ",-1"
                                                                  : fmt::format(",{}", vertices[disc]);
    file.write(fmt::format("{},{}{}{}\n", disc++, by_band[0].hits, line, vertex));
  });
  file.commit();
}

}  // namespace

WrittenRun write_files(const RunFiles& files, const Job& job, const RunAnswer& answer, const std::stop_token& stop) {
  WrittenRun written;
  const sim::Outcome& outcome = answer.run.outcome;
  if (outcome.stopped) {
    // By the photons so far, the irradiance is an estimate; sums over other rays would be too small.
    const bool is_estimate = answer.taken.has_value();
    if ((files.per_disc && !is_estimate) || files.pairs)
      written.notices.emplace_back(
          "stopped before the end: --per-disc and --pairs are not written, because they would be partial");
    if (is_estimate && files.per_disc) {
      written.notices.push_back(fmt::format("{} has the irradiance by the photons of the first {} rays",
                                            *files.per_disc, outcome.progress.done));
      write_per_disc(*files.per_disc, answer.run, job, {});
    }
    written.stopped = outcome.progress;
    return written;
  }
  try {
    if (files.per_disc) write_per_disc(*files.per_disc, answer.run, job, stop);
    if (files.pairs) write_pairs(*files.pairs, answer.run, job.file_order, stop);
  } catch (const sim::Stopped& stopped) {
    written.notices.push_back(fmt::format("{}; the file is not kept", stopped.what()));
    written.stopped = stopped.progress();
    return written;
  }
  if (answer.until && answer.until->result.reason == StopReason::time) {
    written.stopped = outcome.progress;
    return written;
  }
  const std::size_t timed = answer.timing.all.size();
  const auto repeat = static_cast<std::size_t>(answer.request.repeat);
  if (repeat > 0 && timed < repeat) written.stopped = sim::Progress{timed, repeat, "timed runs"};
  return written;
}

}  // namespace detp::validate
