#include "kernel_table.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace detp::benchmarks {
namespace {

constexpr int repeats = 5;

double flops() {
  static const double measured = peak_flops();
  return measured;
}

/// Bandwidth for a working set of `bytes` bytes. Each bandwidth is measured only once.
double bandwidth(double (*measure)(std::size_t), std::size_t bytes) {
  static std::map<std::pair<double (*)(std::size_t), std::size_t>, double> known;
  const auto [place, is_new] = known.try_emplace({measure, bytes});
  if (is_new) place->second = measure(bytes);
  return place->second;
}

struct Limit {
  double seconds;
  const char* name;
};

Limit limit(const Work& work) {
  const Limit limits[] = {{work.flops / flops(), "flops"},
                          {work.loaded / bandwidth(load_bandwidth, work.working_set), "loads"},
                          {work.stored / bandwidth(store_bandwidth, work.working_set), "stores"},
                          {work.packing, "packing"}};
  return *std::max_element(std::begin(limits), std::end(limits),
                           [](const Limit& a, const Limit& b) { return a.seconds < b.seconds; });
}

struct Row {
  std::string name;
  Work work;
  double seconds = std::numeric_limits<double>::infinity();
};

std::vector<Row>& rows() {
  static std::vector<Row> all;
  return all;
}

/// Keeps the shortest time of each row over its repeats, and prints the row after its last repeat.
class BestOfRepeats final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override {
    std::puts("| kernel | rays | list | | ns/test | GB/s | Gflop/s | limit, ns | by | of the limit |");
    std::puts("|--------|------|------|-|--------:|-----:|--------:|----------:|----|-------------:|");
    return true;
  }

  void ReportRuns(const std::vector<Run>& runs) override {
    if (runs.empty() || runs.front().run_type != Run::RT_Iteration) return;  // skips aggregates such as means
    for (const Run& run : runs) {
      Row& row = rows()[static_cast<std::size_t>(run.counters.at("row").value)];
      row.seconds = std::min(row.seconds, run.cpu_accumulated_time / static_cast<double>(run.iterations));
    }
    print(rows()[static_cast<std::size_t>(runs.front().counters.at("row").value)]);
  }

 private:
  static void print(const Row& row) {
    const Work& work = row.work;
    const Limit least = limit(work);
    std::printf("| %s | %.3f | %.0f | %.0f | %.3f | %s | %.0f %% |\n", row.name.c_str(), 1e9 * row.seconds / work.tests,
                1e-9 * (work.loaded + work.stored) / row.seconds, 1e-9 * work.flops / row.seconds,
                1e9 * least.seconds / work.tests, least.name, 100 * least.seconds / row.seconds);
    std::fflush(stdout);
  }
};

}  // namespace

void add_row(const std::string& name, const Work& work, std::function<void()> kernel) {
  const std::size_t number = rows().size();
  rows().push_back({name, work});
  benchmark::RegisterBenchmark(name.c_str(),
                               [number, kernel = std::move(kernel)](benchmark::State& state) mutable {
                                 for (auto _ : state) kernel();
                                 state.counters["row"] = static_cast<double>(number);
                               })
      ->Repetitions(repeats)
      ->MinTime(0.02);
}

void print_peaks() {
  std::printf("%s, vectors of %zu floats; peak %.0f Gflop/s\n", instructions(), vector_length(), 1e-9 * flops());
  for (const std::size_t size :
       {std::size_t{24} << 10, std::size_t{512} << 10, std::size_t{8} << 20, std::size_t{128} << 20})
    std::printf("%zu KiB: loads %.0f GB/s, stores %.0f GB/s\n", size >> 10, 1e-9 * load_bandwidth(size),
                1e-9 * store_bandwidth(size));
  for (const std::size_t size : {512, 12'288, 262'144})
    for (const double share : {0.1, 0.3, 1.0})
      std::printf("packing 5 arrays of %zu, %.0f %% kept: by Compress %.2f ns a vector, by permutation %.2f ns\n", size,
                  100 * share, 1e9 * packing_time(Packing::compress, 5, size, share),
                  1e9 * packing_time(Packing::permute, 5, size, share));
}

void run_rows() {
  BestOfRepeats table;
  benchmark::RunSpecifiedBenchmarks(&table);
  benchmark::Shutdown();
}

}  // namespace detp::benchmarks
