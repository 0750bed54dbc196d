#pragma once

#include <filesystem>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "deviation.hpp"

namespace detp::validate {

/// The measurements of a sweep so far, stored in a checkpoint file under the name of their point.
class Checkpoint {
 public:
  /// An empty checkpoint. `formulas` is a digest of formulas and points. A sweep can be continued only with an equal one.
  Checkpoint(std::filesystem::path path, std::uint64_t seed, const std::string& formulas);

  /// Reads the file. Throws as CheckpointFile. A missing file is an empty checkpoint.
  void read(std::stop_token stop = {});

  /// Adds a point and writes the file. Throws sim::FileError if it cannot be written.
  void add(const std::string& point, const std::vector<Deviation>& deviations);

  [[nodiscard]] const std::map<std::string, std::vector<Deviation>>& points() const { return points_; }

 private:
  CheckpointFile file_;
  std::map<std::string, std::vector<Deviation>> points_;
};

}  // namespace detp::validate
