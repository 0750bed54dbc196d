#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "detp/sim/base/spill_file.hpp"
#include "disc_cut.hpp"

namespace detp::sim {

/// Some parts of the discs, each in memory only when it is asked for.
class DiscParts {
 public:
  /// The parts first … first + count - 1 of the cut. Reads all discs once. Several parts go to a SpillFile of 64 bytes a disc; one stays in memory.
  /// Throws as DiscSource::read and SpillFile.
  DiscParts(const DiscSource& discs, const DiscCut& cut, std::size_t first, std::size_t count,
            const std::stop_token& stop = {});

  [[nodiscard]] std::size_t count() const { return parts_.size(); }
  /// The i-th of these parts; a single one can be taken once.
  [[nodiscard]] PartOfDiscs take(std::size_t i);

 private:
  struct Numbered {
    Disc disc;
    std::uint64_t number;
  };
  struct Chunk {
    std::uint64_t offset;  ///< in the file, bytes
    std::size_t discs;
  };
  struct Part {
    std::vector<Chunk> chunks;
    std::vector<Numbered> last;  ///< not yet in the file
  };

  void spill(Part& part);

  PartOfDiscs single_;
  std::vector<Part> parts_;
  SpillFile file_;
};

}  // namespace detp::sim
