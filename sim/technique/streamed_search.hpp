#pragma once

#include <memory>

#include "detp/sim/base/scratch.hpp"
#include "detp/sim/search/index.hpp"
#include "streamed.hpp"

/// A search of streamed rays whose ranges are searched one after another.
namespace detp::sim {

/// What run_streamed does, in steps. Keeps references to discs, source and options. Callers set the default floating-point mode.
class StreamedSearch {
 public:
  /// Builds the index. `options.last` - `options.first`: number of rays that are expected, for progress and the size of blocks. Throws as run_streamed.
  StreamedSearch(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                 const StreamOptions& options);

  /// Searches rays first … last - 1. Their hits go to `totals`; without, the outcome has hits and irradiance. Does nothing after a stop.
  void search(std::uint64_t first, std::uint64_t last, Totals* totals);

  /// What was found since the last call. The first has the building.
  [[nodiscard]] StreamedOutcome take();
  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  Problem problem_of(std::span<const Disc> discs);
  void predict_bytes();
  [[nodiscard]] double expected() const { return static_cast<double>(expected_); }

  const RaySource& source_;
  const StreamOptions& options_;
  RunOptions run_;
  std::uint64_t expected_;
  std::uint64_t searched_ = 0;
  double searching_ = 0;  ///< rays of the range under way
  StreamedOutcome streamed_;
  Problem problem_;
  std::unique_ptr<Index> index_;
  Scratch scratch_;
  double own_bytes_ = 0;
  bool stopped_ = false;
};

}  // namespace detp::sim
