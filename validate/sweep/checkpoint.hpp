#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "deviation.hpp"

namespace detp::validate {

/// The measurements of a sweep so far, stored in a JSON file under the name of their point.
class Checkpoint {
 public:
  /// An empty checkpoint. `fingerprint` identifies the formulas and points. A sweep can be continued only with an equal
  /// fingerprint.
  Checkpoint(std::filesystem::path path, std::uint64_t seed, std::uint64_t fingerprint);

  /// Reads the file. Throws sim::FileError if it is malformed, or was made with another seed or fingerprint. A missing
  /// file is an empty checkpoint. Throws sim::Stopped within 0.1 s of a stop request.
  void read(std::stop_token stop = {});

  /// Adds a point and replaces the file as a whole, so that the file is valid at any moment. Throws sim::FileError if
  /// it cannot be written.
  void add(const std::string& point, const std::vector<Deviation>& deviations);

  [[nodiscard]] const std::map<std::string, std::vector<Deviation>>& points() const { return points_; }

 private:
  std::filesystem::path path_;
  std::uint64_t seed_;
  std::uint64_t fingerprint_;
  std::map<std::string, std::vector<Deviation>> points_;
};

}  // namespace detp::validate
