#include "choose_rows.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace detp::cli {

int threads_of(const ChooseRow& row) { return row.run != nullptr ? row.run->threads : row.predicted->threads; }

std::vector<ChooseRow> rows_of(const ChooseAnswer& answer) {
  std::vector<ChooseRow> rows;
  if (!answer.analysis) {
    for (const Prediction& ranked : answer.choice.candidates) rows.push_back({ranked.candidate, &ranked});
    rows.front().chosen = true;
    return rows;
  }
  for (const validate::Analysed& run : answer.analysis->candidates)
    rows.push_back({run.candidate, run.predicted ? &*run.predicted : nullptr, &run});
  rows[answer.analysis->best.value_or(0)].chosen = true;
  return rows;
}

const Prediction* piloted(const ChooseAnswer& answer, const ChooseRow& row) {
  if (!answer.by_sample()) return nullptr;
  for (const Prediction& one : answer.choice.candidates)
    if (one.candidate == row.candidate) return &one;
  return nullptr;
}

std::optional<double> error_of(const ChooseAnswer& answer, const ChooseRow& row) {
  const Prediction* const one = piloted(answer, row);
  return one == nullptr ? std::nullopt : std::optional(one->error);
}

bool could_win(const ChooseAnswer& answer, const ChooseRow& row) {
  return row.predicted->time.total() < (1 + validate::distinguishable) * answer.choice.best().time.total();
}

std::string largest_part(const CostBreakdown& time) {
  const std::array<std::pair<double, const char*>, 7> parts{{{time.order, "sorting samples"},
                                                             {time.build, "building the index"},
                                                             {time.rebuild, "ray-sphere tests"},
                                                             {time.copy, "copying lists"},
                                                             {time.traverse, "stepping through the index"},
                                                             {time.intersect, "ray-disc tests"},
                                                             {time.touch, "touching new memory"}}};
  return std::max_element(parts.begin(), parts.end())->second;
}

}  // namespace detp::cli
