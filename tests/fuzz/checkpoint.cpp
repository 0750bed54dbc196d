// Checkpoint files of the sweep: reading either succeeds or throws FileError. A checkpoint that was read can be written
// and read again.

#include "detp/sim/files/file_error.hpp"
#include "detp/validate/base/json.hpp"
#include "detp/validate/sweep/sweep.hpp"
#include "scratch.hpp"

namespace {

/// With version and checksum that fit, so that not every mutation ends there.
std::string sealed(std::string_view text) {
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("work") || !json.contains("key") || !json.contains("state"))
    return std::string(text);
  json["schema"] = {{"name", "detp.checkpoint"}, {"version", detp::validate::checkpoint_version}};
  json["checksum"] = detp::validate::checksum(json["work"], json["key"], json["state"]);
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const detp::fuzz::Scratch scratch(".json");
  const std::string& path = scratch.with(sealed(detp::fuzz::text_of(data, size)));
  try {
    detp::validate::CheckpointFile file(path, "validate --effort thorough",
                                        {{"seed", 1}, {"digest of formulas and workloads", "2"}});
    auto points = detp::validate::read_points(file);
    points["one more"] = {};
    detp::validate::write_points(file, points);
    if (detp::validate::read_points(file).size() < points.size()) std::abort();
  } catch (const detp::sim::FileError&) {
  }
  return 0;
}
