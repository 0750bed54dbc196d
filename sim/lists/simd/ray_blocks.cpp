#include "ray_blocks.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "detp/sim/base/parallel.hpp"

namespace detp::sim::stream {
namespace {

/// Rows of powers of a block, in a small array of their own, stay in the second-level cache: with 32 768 rays and three bands, a search takes 1.1
/// instead of 1.3 times as long as in one band. More doubles than this are better left where they are.
constexpr std::size_t most_copied = std::size_t{1} << 18;

/// Rays for which a list needs room beyond its own, for each piece that it is loaded in.
constexpr std::size_t room_of_piece = 2 * padding;

/// Loads the pieces at the same time, and moves their lists together.
RayTraits load_in_pieces(std::span<const Ray> rays, const Frame& frame, std::size_t pieces, RayLists& lists) {
  const std::size_t step = (rays.size() / pieces / padding + 1) * padding;
  struct Piece {
    RayLists lists;
    RayTraits traits;
  };
  std::vector<Piece> all(pieces);
  sim::parallel_for(std::size_t{0}, pieces, [&](std::size_t i) {
    const std::size_t first = std::min(i * step, rays.size());
    const auto some = rays.subspan(first, std::min(step, rays.size() - first));
    for (std::size_t k = 0; k < classes; ++k) all[i].lists[k] = part_of(lists[k], i * (step + room_of_piece), 0);
    if (!some.empty()) all[i].traits = load_rays(some, frame, all[i].lists, static_cast<std::uint32_t>(first));
  });
  RayTraits traits = all.front().traits;
  for (const Piece& piece : all) {
    if (size(piece.lists) == 0) continue;
    traits.segments |= piece.traits.segments;
    if (piece.traits.power != traits.power) traits.power = std::nullopt;
  }
  constexpr std::size_t arrays = 7;
  sim::parallel_for(std::size_t{0}, classes * arrays, [&](std::size_t i) {
    const std::size_t k = i / arrays;
    const auto array = [&](const RayList& list) -> void* {
      const std::array<void*, arrays> of_list{list.a, list.b, list.p, list.q, list.id, list.from, list.to};
      return of_list[i % arrays];
    };
    auto* const start = static_cast<char*>(array(lists[k]));
    if (start == nullptr) return;
    std::size_t end = 0;
    for (const Piece& piece : all) {
      const RayList& list = piece.lists[k];
      if (list.size > 0) std::memmove(start + sizeof(float) * end, array(list), sizeof(float) * list.size);
      end += list.size;
    }
  });
  for (std::size_t k = 0; k < classes; ++k) {
    for (const Piece& piece : all) lists[k].size += piece.lists[k].size;
    clear_padding(lists[k]);
  }
  return traits;
}

}  // namespace

void Block::load(const Problem& problem, const Frame& frame, std::size_t first, std::size_t size, std::size_t pieces) {
  first_ = first;
  size_ = 0;
  if (first >= problem.rays().size()) return;
  const auto rays = problem.rays().subspan(first, std::min(size, problem.rays().size() - first));
  arena_.release({});
  capacity_ = std::max(capacity_, rays.size() + pieces * room_of_piece);
  // A third of the rays is expected in each class.
  for (RayList& list : lists_) list = arena_.allocate(capacity_, problem.segments(), rays.size() / classes);
  size_ = rays.size();
  traits_ = pieces == 1 ? load_rays(rays, frame, lists_) : load_in_pieces(rays, frame, pieces, lists_);
  if (!keep_powers_) return;
  powers_.resize(capacity_);
  for (std::size_t i = 0; i < rays.size(); ++i) powers_[i] = rays[i].power;
  const std::size_t bands = problem.further().bands;
  const double* const from = problem.further().values.data() + first * bands;
  further_powers_ = from;
  if (bands == 0 || bands * capacity_ > most_copied) return;
  further_.assign(from, from + bands * rays.size());
  further_powers_ = further_.data();
}

bool needs_powers(const Problem& problem, const RunOptions& options) {
  const bool errors = options.totals == nullptr ? options.standard_error : options.totals->keeps_errors();
  return !problem.one_power() || options.pairs || problem.front_facing() || (errors && problem.numbered());
}

}  // namespace detp::sim::stream
