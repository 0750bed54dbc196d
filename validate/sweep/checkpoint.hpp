#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "deviation.hpp"

namespace detp::validate {

/// The measurements of a sweep so far, by name of the point, kept in a JSON file.
class Checkpoint {
 public:
  /// An empty checkpoint. `fingerprint` identifies the formulas and points; measurements with another fingerprint
  /// cannot be continued.
  Checkpoint(std::filesystem::path path, std::uint64_t seed, std::uint64_t fingerprint);

  /// Reads the file. Throws sim::FileError if it is malformed, or was made with another seed or fingerprint. A missing
  /// file is an empty checkpoint. Throws sim::Stopped within 0.1 s of a stop request.
  void read(std::stop_token stop = {});

  /// Adds a point and rewrites the file. The file is replaced as a whole, so it is valid at any moment.
  void add(const std::string& point, const std::vector<Deviation>& deviations);

  [[nodiscard]] const std::map<std::string, std::vector<Deviation>>& points() const { return points_; }

 private:
  std::filesystem::path path_;
  std::uint64_t seed_;
  std::uint64_t fingerprint_;
  std::map<std::string, std::vector<Deviation>> points_;
};

}  // namespace detp::validate
