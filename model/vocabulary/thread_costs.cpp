#include "thread_costs.hpp"

#include <algorithm>
#include <cmath>

#include "checks.hpp"

namespace detp {
namespace {

/// Smaller arrays of discs are sorted, and smaller trees built, by one thread.
constexpr double discs_in_piece = 1 << 14;

double pieces_of_search(const Counts<double>& counts, Division division) {
  switch (division) {
    case Division::none:
      return 1;
    case Division::rays:
      return counts.loaded / rays_in_chunk;
    case Division::discs:
      return counts.loaded > 0 ? counts.disc_tests / counts.loaded / discs_in_chunk : 1;
    case Division::axes:
      return 3;
    case Division::nodes: {
      constexpr double children = 8;
      const double lists = counts.loaded / rays_to_divide;  // at the root
      return lists < 1 ? 1 : children * lists;
    }
  }
  return 1;
}

}  // namespace

void check(const ThreadCosts& costs) {
  require_share("serial share of sorting and building", costs.serial_preparing);
  require_share("serial share of the search", costs.serial_search);
  require_non_negative("time for starting a thread", costs.start);
}

Pieces pieces_of(const Counts<double>& counts, Technique technique, Engine engine) {
  const WorkDivision& division = record_of(technique).division;
  const double discs = std::max(counts.sorted, counts.placements);
  return {.preparing = division.preparing ? std::max(1.0, discs / discs_in_piece) : 1,
          .search = std::max(1.0, pieces_of_search(counts, engine == Engine::plain ? division.plain : division.simd))};
}

double busy_threads(double pieces, int threads) {
  const double whole = std::max(1.0, std::floor(pieces));
  return whole / std::ceil(whole / threads);
}

CostBreakdown on_threads(const CostBreakdown& one, const Pieces& pieces, const ThreadCosts& costs, int threads) {
  const double preparing_threads = busy_threads(pieces.preparing, threads);
  const double search_threads = busy_threads(pieces.search, threads);
  if (preparing_threads == 1 && search_threads == 1) return one;
  const double preparing = costs.serial_preparing + (1 - costs.serial_preparing) / preparing_threads;
  const double search = costs.serial_search + (1 - costs.serial_search) / search_threads;
  return {.start = search * one.start + costs.start * (threads - 1),
          .order = preparing * one.order,
          .build = preparing * one.build,
          .rebuild = search * one.rebuild,
          .copy = search * one.copy,
          .traverse = search * one.traverse,
          .intersect = search * one.intersect,
          .touch = search * one.touch};
}

std::vector<int> thread_numbers(int most) {
  std::vector<int> numbers;
  for (int threads = 1; threads < most; threads *= 2) numbers.push_back(threads);
  numbers.push_back(most);
  return numbers;
}

}  // namespace detp
