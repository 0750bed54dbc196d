#include "plan_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "detp/sim/base/threads.hpp"

namespace detp::validate {
namespace {

/// The better of two choices compares greater.
auto worth(const RememberedChoice& choice) { return std::tuple(choice.rigor, !choice.cut_off); }

std::string describe_choice(const RememberedChoice& choice) {
  return fmt::format("{} by rigor {}{}", title(choice.candidate), name(choice.rigor),
                     choice.cut_off ? ", cut off" : "");
}

/// In how much two classes differ, to find the nearest one for a message.
int distance(const WorkloadClass& a, const WorkloadClass& b) {
  return std::abs(a.rays - b.rays) + std::abs(a.discs - b.discs) + std::abs(a.spacing - b.spacing) +
         std::abs(a.dimension - b.dimension) + std::abs(a.path_length - b.path_length) +
         (a.front_facing != b.front_facing ? 1 : 0);
}

}  // namespace

void PlanMemory::remember(const WorkloadClass& workload, const RememberedChoice& choice) {
  check(choice.candidate);
  if (!record_of(choice.candidate.technique).exact)
    throw std::invalid_argument(
        fmt::format("{} is never chosen, because it is not exact", name(choice.candidate.technique)));
  require_count("number of threads", choice.threads, 0, sim::most_threads);
  require_non_negative("predicted seconds", choice.predicted_seconds);
  require_non_negative("error of the predicted seconds", choice.predicted_error);
  const std::lock_guard lock(mutex_);
  const auto [place, added] = choices_.try_emplace(workload, choice);
  if (!added && worth(choice) >= worth(place->second)) place->second = choice;
}

std::optional<RememberedChoice> PlanMemory::find(const WorkloadClass& workload, Rigor least) const {
  const std::lock_guard lock(mutex_);
  const auto found = choices_.find(workload);
  if (found == choices_.end() || found->second.rigor < least) return std::nullopt;
  return found->second;
}

RememberedChoice PlanMemory::require(const WorkloadClass& workload, Rigor least) const {
  if (const auto found = find(workload, least)) return *found;
  const std::string wanted =
      fmt::format("no remembered choice: wanted rigor {} for {}; ", name(least), describe(workload));
  const std::vector<Entry> all = entries();
  if (all.empty()) throw NotRemembered(wanted + "nothing is remembered");
  const auto nearest = std::min_element(all.begin(), all.end(), [&](const Entry& a, const Entry& b) {
    return distance(a.workload, workload) < distance(b.workload, workload);
  });
  const bool same = nearest->workload == workload;
  throw NotRemembered(fmt::format("{}{} {}: {}", wanted, same ? "remembered for these is" : "the nearest is for",
                                  same ? "only" : describe(nearest->workload), describe_choice(nearest->choice)));
}

std::vector<PlanMemory::Entry> PlanMemory::entries() const {
  const std::lock_guard lock(mutex_);
  std::vector<Entry> all;
  all.reserve(choices_.size());
  for (const auto& [workload, choice] : choices_) all.push_back({workload, choice});
  return all;
}

std::size_t PlanMemory::size() const {
  const std::lock_guard lock(mutex_);
  return choices_.size();
}

}  // namespace detp::validate
