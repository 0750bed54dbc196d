#include "summary.hpp"

#include <algorithm>
#include <cmath>

namespace detp::validate {

std::optional<AgainstEmbree> against_embree(std::span<const BenchEntry> entries, int threads, Ours ours) {
  AgainstEmbree summary{.threads = threads, .worst_entry = 0};
  double logarithms = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double ratio = ours == Ours::best ? entries[i].ratio() : entries[i].choice_ratio();
    if (entries[i].threads != threads || !(ratio > 0)) continue;
    if (summary.races == 0 || ratio < summary.worst) {
      summary.worst = ratio;
      summary.worst_entry = i;
    }
    ++summary.races;
    logarithms += std::log(ratio);
  }
  if (summary.races == 0) return std::nullopt;
  summary.geometric_mean = std::exp(logarithms / static_cast<double>(summary.races));
  return summary;
}

double kept_by_choice(std::span<const BenchEntry> entries, int threads) {
  double logarithms = 0;
  double races = 0;
  for (const BenchEntry& entry : entries)
    if (entry.threads == threads && entry.choice_ratio() > 0) {
      logarithms += std::log(entry.choice_ratio() / entry.ratio());
      ++races;
    }
  return races > 0 ? std::exp(logarithms / races) : 0;
}

bool do_own_hits_agree(std::span<const BenchEntry> entries) {
  return std::all_of(entries.begin(), entries.end(), [](const BenchEntry& entry) {
    return std::all_of(entry.race.results.begin(), entry.race.results.end(), [](const CompetitorResult& result) {
      return is_embree(result.competitor) || result.wrong_hits == 0;
    });
  });
}

WrongHits embree_wrong_hits(std::span<const BenchEntry> entries) {
  WrongHits sum;
  for (const BenchEntry& entry : entries)
    for (const CompetitorResult& result : entry.race.results)
      if (is_embree(result.competitor)) {
        sum.wrong += result.wrong_hits;
        sum.hits += result.hits;
      }
  return sum;
}

}  // namespace detp::validate
