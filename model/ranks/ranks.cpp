#include "ranks.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/model/vocabulary/engine.hpp"

namespace detp::model {
namespace {

// README.md compares what these numbers predict with runs.
constexpr double disc_bytes = 56;
constexpr double index_bytes = 140;  // of a disc in a box tree: a copy of the disc in its order, and nodes
constexpr double sums_bytes = 32;    // under way
constexpr double result_bytes = 16;  // hits and irradiance
constexpr double error_sums = 56;    // with standard errors
constexpr double error_results = 16;
constexpr double ray_bytes = 64 + 8 + 2 * 28;  // in a block: the ray, its photon, and two lists
constexpr double kept_ray_bytes = 64 + 8;
constexpr double number_bytes = 4;

double blocks_of(const SharedSearch& search) {
  return std::max(1.0, std::ceil(search.photons / search.photons_in_block));
}

double levels_of(double blocks) { return std::max(1.0, std::ceil(std::log2(blocks + 1))); }

double block_of_rays(const SharedSearch& search) {
  constexpr double many = 1e9;  // more discs make no difference
  const auto discs = static_cast<std::size_t>(std::min(search.discs, many));
  const double block = std::max(0x1p18, static_cast<double>(rays_in_block(discs)));
  return ray_bytes * std::min(search.rays, block);
}

/// Of all that a search of so many discs keeps, results besides.
double search_bytes(const SharedSearch& search, double discs, double levels) {
  const double errors = search.standard_errors ? error_sums + 8 * levels : 0;
  return discs * (index_bytes + sums_bytes + 8 * levels + errors);
}

double results_bytes(const SharedSearch& search) {
  return search.discs * (result_bytes + (search.standard_errors ? error_results : 0));
}

/// Several ranks count photon paths before they search them; one alone counts them as it searches.
bool counts_ahead(const SharedSearch& search, double ranks) { return search.photon_paths && ranks > 1; }

/// Of the photon paths that a rank counts ahead, the share that it keeps.
double kept_share(const SharedSearch& search, double ranks) {
  return counts_ahead(search, ranks) ? std::min(1.0, search.kept_bytes / (kept_ray_bytes * search.rays / ranks)) : 0;
}

double fixed_bytes(const SharedSearch& search, double ranks) {
  const double kept = kept_share(search, ranks) * kept_ray_bytes * search.rays / ranks;
  return search.scene_bytes + search.discs * disc_bytes + block_of_rays(search) + results_bytes(search) + kept;
}

void check_ranks(const SharedSearch& search, double ranks, const Network& network) {
  check(search);
  require_count("number of ranks", ranks, 1, 1e9);
  require_positive("bytes per second of the network", network.bytes_per_second);
  require_non_negative("latency of the network", network.latency);
}

double collect_seconds(double ranks, double bytes, const Network& network) {
  return (ranks - 1) * (network.latency + bytes / network.bytes_per_second);
}

}  // namespace

double share_of_each_ray(const Prediction& prediction, const UnitCosts& costs, double discs) {
  const Counts<double>& counts = prediction.counts;
  const auto* const tree = std::get_if<BoxTreeParameters>(&prediction.candidate.parameters);
  const double children = tree != nullptr ? tree->fan_out : 0;
  const Counts<double> each{.loaded = counts.loaded,
                            .segments = counts.segments,
                            .cull_tests = std::min(counts.cull_tests, children * counts.loaded),
                            .culls = children * detp::blocks_of(counts.loaded, discs),
                            .references = discs};
  const Technique technique = prediction.candidate.technique;
  const CostBreakdown all = price(counts, costs, technique);
  const double search = all.total() - all.order - all.build;
  return search > 0 ? std::min(1.0, price(each, costs, technique).total() / search) : 0;
}

void check(const SharedSearch& search) {
  require_count("number of rays", search.rays, 1, 1e18);
  require_positive("number of photons", search.photons);
  require_count("number of discs", search.discs, 1, 1e18);
  require_count("photons in a block", search.photons_in_block, 1, 1e18);
  require_non_negative("seconds for making rays", search.make_seconds);
  require_non_negative("seconds for the index", search.build_seconds);
  require_non_negative("seconds for the search", search.search_seconds);
  require_non_negative("seconds of each ray", search.each_ray_seconds);
  if (search.each_ray_seconds > search.search_seconds)
    throw std::invalid_argument("the seconds of each ray are a part of those of the search");
  require_non_negative("bytes of the scene", search.scene_bytes);
  require_non_negative("bytes of kept rays", search.kept_bytes);
}

SharedTime share_rays(const SharedSearch& search, double ranks, const Network& network) {
  check_ranks(search, ranks, network);
  const double blocks = blocks_of(search);
  const double own_blocks = std::ceil(blocks / ranks);
  const double share = own_blocks / blocks;
  const double subtrees = std::max(1.0, 2 * std::log2(own_blocks));
  const double errors = search.standard_errors ? error_sums + 8 * subtrees : 0;
  const double message = ranks > 1 ? search.discs * (sums_bytes + 8 * subtrees + errors) : 0;
  return {.count = counts_ahead(search, ranks) ? search.make_seconds / ranks : 0,
          .make = share * (1 - kept_share(search, ranks)) * search.make_seconds,
          .build = search.build_seconds,
          .search = share * search.search_seconds,
          .collect = collect_seconds(ranks, message, network),
          .memory = fixed_bytes(search, ranks) + search_bytes(search, search.discs, levels_of(blocks)) + message,
          .traffic = (ranks - 1) * message};
}

SharedTime share_discs(const SharedSearch& search, double ranks, const Network& network) {
  check_ranks(search, ranks, network);
  const double discs = std::ceil(search.discs / ranks);
  const double result = number_bytes + result_bytes + (search.standard_errors ? error_results : 0);
  const double message = ranks > 1 ? discs * result : 0;
  return {.count = counts_ahead(search, ranks) ? search.make_seconds / ranks : 0,
          .make = (1 - kept_share(search, ranks) / ranks) * search.make_seconds,
          .build = search.build_seconds / ranks,
          .search = search.each_ray_seconds + (search.search_seconds - search.each_ray_seconds) / ranks,
          .collect = collect_seconds(ranks, message, network),
          .memory = fixed_bytes(search, ranks) + search_bytes(search, discs, levels_of(blocks_of(search))) +
                    discs * disc_bytes,
          .traffic = (ranks - 1) * message};
}

}  // namespace detp::model
