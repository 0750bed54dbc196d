#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <stop_token>
#include <string>

#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "detp/validate/choice/analysis.hpp"

namespace detp::validate {

/// The measured cells of a map, in a checkpoint file.
class MapCheckpoint {
 public:
  /// `key` as of CheckpointFile.
  MapCheckpoint(std::filesystem::path path, nlohmann::json key) : file_(std::move(path), "map", std::move(key)) {}

  /// Throws as CheckpointFile::read. A missing file has no cells.
  void read(std::stop_token stop = {});

  /// The cell's analysis, if the file has it. Its predictions are those of the ranking.
  [[nodiscard]] std::optional<Analysis> find(const std::string& cell, const std::vector<Prediction>& ranking) const;

  /// Adds a cell; writes the file if that is cheap enough. Throws sim::FileError if it cannot be written.
  void add(const std::string& cell, const Analysis& analysis);
  void write() { file_.write(cells_); }

 private:
  CheckpointFile file_;
  std::map<std::string, nlohmann::json> cells_;
};

}  // namespace detp::validate
