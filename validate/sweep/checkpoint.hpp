#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "deviation.hpp"

namespace detp::validate {

/// What a sweep has measured so far, by the name of the point, kept in a file (JSON).
class Checkpoint {
 public:
  /// Empty. `fingerprint` is of the formulas and points: what was measured with others is not to be continued.
  Checkpoint(std::filesystem::path path, std::uint64_t seed, std::uint64_t fingerprint);

  /// Reads the file. Throws sim::FileError where it is malformed, or was made with another seed or fingerprint. A
  /// missing file is an empty checkpoint. Throws sim::Stopped within 0.1 s of a stop request.
  void read(std::stop_token stop = {});

  /// Adds a point and writes all, aside first, so that the file is whole at any moment.
  void add(const std::string& point, const std::vector<Deviation>& deviations);

  [[nodiscard]] const std::map<std::string, std::vector<Deviation>>& points() const { return points_; }

 private:
  std::filesystem::path path_;
  std::uint64_t seed_;
  std::uint64_t fingerprint_;
  std::map<std::string, std::vector<Deviation>> points_;
};

}  // namespace detp::validate
