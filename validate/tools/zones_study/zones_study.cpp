// Where is a sphere cache faster than an index of discs, and which technique is the fastest of all? Judges the paper's rule.
//
//   cmake --build build --target zones_study && build/zones_study zones.csv [FOLDER OF MESHES]
//
// For each workload (zone_workloads.hpp), by the simd and the plain engine: the fastest parameters of each technique, found by
// running their neighbours, then all techniques in turns on other runs. Rows by role:
//
//     best           the technique with its fastest parameters
//     published-Q    the sphere cache with the paper's Q
//     rule           the candidate of the paper's rule
//     index          the faster of octree and BSP tree
//     fastest        of all
//     predicted      of sphere cache and octree the one that closed forms take
//
// `over_cache` is the median of a candidate's seconds over those of the fastest sphere cache in the same round, with the range that
// holds the true median with 96 % (of 9 rounds; 94 % of 5, 75 % of 3: slow runs have fewer); `over_two` the same over the faster of sphere cache and index.
// `predicted_seconds` are those of the technique's best candidate by closed forms, with the unit costs of `detp calibrate`, if it was run,
// else the built-in ones. Techniques that took ten times as long as the fastest in their first run are abandoned; `seconds` is then
// a lower bound. Other techniques than the paper's have tuned parameters only if they may win. One thread; 45 minutes. Goes on where
// the file ends.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/paper_rule.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/regret/timed_rounds.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "fastest_of.hpp"
#include "zone_workloads.hpp"

namespace {

using namespace detp;

constexpr std::uint64_t seed = 51;
constexpr double hopelessly_behind = 10;
constexpr double cannot_win =
    3;  ///< parameters of other techniques than the paper's are not tuned if the first run takes so many times
        ///< as long as the fastest
constexpr double always_tuned = 0.02;  ///< seconds; what is shorter is tuned in any case
constexpr double no_limit = 1e6;       ///< seconds
constexpr validate::RoundLimits limits{.rounds = 9, .behind = hopelessly_behind, .most_seconds = 5};

struct Entry {
  std::string
      role;  ///< "best" of its technique, the sphere cache with the "published-Q", or the candidate of the "rule"
  zones::FirstRuns runs;
  double predicted = 0;  ///< seconds; 0: no closed form
  std::vector<double> times = {};
};

/// The paper's three techniques come first, and are never abandoned.
std::vector<Technique> in_order() {
  std::vector<Technique> all{Technique::sphere_cache, Technique::octree, Technique::bsp};
  for (const Technique technique : exact_techniques)
    if (std::find(all.begin(), all.end(), technique) == all.end()) all.push_back(technique);
  return all;
}

/// The fastest sphere cache with the paper's Q: tries three numbers of spheres. nullopt if it has none.
std::optional<zones::FirstRuns> with_published_ratio(const validate::Job& job, const CostTable& costs) {
  const std::int64_t best =
      model::best_stop(job.workload(), costs[Technique::sphere_cache], {model::published_ratio}).spheres;
  std::optional<zones::FirstRuns> fastest;
  for (const std::int64_t spheres : {best - 1, best, best + 1}) {
    if (spheres < 1) continue;
    const Candidate candidate{Technique::sphere_cache, SphereCacheParameters{model::published_ratio, spheres}};
    const auto runs = zones::fastest_of(job.problem(), candidate, costs.engine, {.first = no_limit, .tuned = 0});
    if (!fastest || runs->seconds < fastest->seconds) fastest = runs;
  }
  return fastest;
}

std::vector<Entry> time_all(const validate::Job& job, const CostTable& costs) {
  const sim::Problem& problem = job.problem();
  std::vector<Entry> entries;
  double fastest = no_limit;
  for (const Technique technique : in_order()) {
    const auto best = model::best_of(technique, job.workload(), costs);
    const Candidate first = best ? best->candidate : default_candidate(technique);
    const bool of_paper = entries.size() < 3;
    const auto runs = zones::fastest_of(problem, first, costs.engine,
                                        {.first = of_paper ? no_limit : hopelessly_behind * fastest,
                                         .tuned = of_paper ? no_limit : std::max(cannot_win * fastest, always_tuned)});
    if (!runs) continue;
    entries.push_back({"best", *runs, best ? best->seconds() : 0});
    if (!runs->abandoned) fastest = std::min(fastest, runs->seconds);
  }
  if (auto published = with_published_ratio(job, costs)) entries.push_back({"published-Q", *published});
  const Candidate rule = model::paper_rule(job.workload());
  if (const auto seconds = zones::time_of(problem, rule, costs.engine, 100 * fastest))
    entries.push_back({"rule", {rule, *seconds, false}});
  else
    entries.push_back({"rule", {rule, 100 * fastest, true}});
  std::vector<Entry*> timed;
  for (Entry& entry : entries)
    if (!entry.runs.abandoned) timed.push_back(&entry);
  const auto times = validate::timed_rounds(timed.size(), limits, [&](std::size_t i) {
    return zones::time_of(problem, timed[i]->runs.candidate, costs.engine, no_limit);
  });
  for (std::size_t i = 0; i < timed.size(); ++i) timed[i]->times = times[i];
  return entries;
}

/// "median,low,high" of the seconds over those of the cache, round by round.
std::string over(const std::vector<double>& times, const std::vector<double>& cache) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(times.size(), cache.size()); ++i) ratios.push_back(times[i] / cache[i]);
  if (ratios.empty()) return ",,";
  std::sort(ratios.begin(), ratios.end());
  const std::size_t out = ratios.size() >= 9 ? 1 : 0;
  return fmt::format("{:.4g},{:.4g},{:.4g}", validate::median(ratios), ratios[out], ratios[ratios.size() - 1 - out]);
}

/// The entries that further roles name.
struct Roles {
  const Entry* cache = nullptr;
  const Entry* index = nullptr;      ///< the faster of octree and BSP tree
  const Entry* fastest = nullptr;    ///< of all
  const Entry* predicted = nullptr;  ///< of sphere cache and octree, by closed forms
};

Roles roles_of(const std::vector<Entry>& entries) {
  Roles roles{.cache = &entries.front()};
  const auto keep_faster = [&](const Entry*& kept, const Entry& entry) {
    if (kept == nullptr || validate::median_ratio(entry.times, kept->times) < 1) kept = &entry;
  };
  for (const Entry& entry : entries) {
    if (entry.times.empty() || entry.role != "best") continue;
    const Technique technique = entry.runs.candidate.technique;
    keep_faster(roles.fastest, entry);
    if (technique == Technique::octree || technique == Technique::bsp) keep_faster(roles.index, entry);
    if (technique == Technique::octree)
      roles.predicted = entry.predicted < roles.cache->predicted ? &entry : roles.cache;
  }
  return roles;
}

std::string rows_of(std::size_t place, const zones::ZoneWorkload& workload, const validate::Job& job,
                    const CostTable& costs) {
  const std::vector<Entry> entries = time_all(job, costs);
  const Roles roles = roles_of(entries);
  const double two =
      roles.index == nullptr ? 1 : std::min(1.0, validate::median_ratio(roles.index->times, roles.cache->times));
  const auto row_of = [&](const std::string& role, const Entry& entry) {
    const Candidate& candidate = entry.runs.candidate;
    std::string parameters = describe(candidate);
    std::replace(parameters.begin(), parameters.end(), ',', ';');
    const std::string over_two =
        entry.times.empty() ? "" : fmt::format("{:.4g}", validate::median_ratio(entry.times, roles.cache->times) / two);
    return fmt::format("{},{},{},{},{},{},{:.4g},{:.4g},{},{},{},{:.4g},{},{},{},{}\n", place, workload.name,
                       workload.field == sim::Field::photons ? "photons" : "isotropic", name(costs.engine),
                       job.given.rays, job.given.samples, job.given.disc_radius,
                       sample_distance(job.workload()) / job.given.disc_radius, role, name(candidate.technique),
                       parameters, entry.times.empty() ? entry.runs.seconds : validate::median(entry.times),
                       over(entry.times, roles.cache->times), over_two, entry.runs.abandoned,
                       entry.predicted > 0 ? fmt::format("{:.4g}", entry.predicted) : "");
  };
  std::string rows;
  for (const Entry& entry : entries) rows += row_of(entry.role, entry);
  if (roles.index != nullptr) rows += row_of("index", *roles.index);
  if (roles.fastest != nullptr) rows += row_of("fastest", *roles.fastest);
  if (roles.predicted != nullptr) rows += row_of("predicted", *roles.predicted);
  return rows;
}

/// Numbers of the workloads whose rows are in the file.
std::set<std::size_t> done_in(const std::string& path) {
  std::set<std::size_t> done;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) done.insert(std::stoull(line));
  return done;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: zones_study FILE [FOLDER OF MESHES]\n");
    return 2;
  }
  const std::string path = argv[1];
  const std::array costs{validate::stored_unit_costs(Engine::simd), validate::stored_unit_costs(Engine::plain)};
  const std::set<std::size_t> done = done_in(path);
  std::ofstream file(path, std::ios::app);
  if (done.empty())
    file << "workload,scene,field,engine,rays,samples,disc_radius,x,role,technique,parameters,seconds,over_cache,"
            "over_cache_low,over_cache_high,over_two,abandoned,predicted_seconds\n";
  const auto workloads = zones::zone_workloads(argc > 2 ? argv[2] : "", seed);
  for (std::size_t place = 0; place < workloads.size(); ++place) {
    if (done.contains(place)) continue;
    const zones::ZoneWorkload& workload = workloads[place];
    fmt::print(stderr, "{} of {}: {}, X = {:.3g}, {} rays\n", place + 1, workloads.size(), workload.name, workload.x,
               workload.rays);
    const validate::Job job = zones::make_zone_job(workload);
    std::string rows;
    for (const CostTable& table : costs) rows += rows_of(place, workload, job, table);
    file << rows << std::flush;
  }
}
