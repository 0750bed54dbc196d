#include "hit_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/sim/files/output_file.hpp"
#include "detp/sim/files/writing_check.hpp"

namespace detp::cli {

void write_pairs(const std::string& path, const TimedRun& run, const std::vector<std::uint32_t>& order,
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

void write_per_disc(const std::string& path, const TimedRun& run, const std::vector<std::uint32_t>& vertices,
                    const std::stop_token& stop) {
  const bool errors = run.results ? run.results->errors() : !run.outcome.standard_error.empty();
  sim::WritingCheck check(path, disc_count(run), "discs", stop);
  sim::OutputFile file(path, stop);
  file.write(fmt::format("disc,hits,irradiance{}{}\n", errors ? ",standard_error,upper_bound,standard_error_weak" : "",
                         vertices.empty() ? "" : ",vertex"));
  std::uint64_t disc = 0;
  for_each_disc(run, [&](const sim::DiscResult& found) {
    check.next();
    const auto finite = [](double one) { return std::isfinite(one) ? fmt::format("{}", one) : std::string(); };
    const bool weak = sim::is_weak(found);
    const std::string error = !errors ? ""
                                      : fmt::format(",{},{},{}", finite(found.standard_error),
                                                    weak ? finite(found.upper_bound) : "", weak ? 1 : 0);
    const std::string vertex = vertices.empty()                   ? ""
                               : vertices[disc] == sim::no_vertex ? ",-1"
                                                                  : fmt::format(",{}", vertices[disc]);
    file.write(fmt::format("{},{},{}{}{}\n", disc++, found.hits, found.irradiance, error, vertex));
  });
  file.commit();
}

}  // namespace detp::cli
