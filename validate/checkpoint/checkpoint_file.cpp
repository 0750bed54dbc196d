#include "checkpoint_file.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/files/input_file.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/validate/base/json.hpp"

namespace detp::validate {
namespace {

constexpr std::string_view checkpoint_schema = "detp.checkpoint";
constexpr std::size_t most_checkpoint_bytes = std::size_t{1} << 32;
constexpr double times_cheaper = 100;
constexpr double first_seconds = 0.1;

/// Each file of this version begins so.
std::string head() {
  return fmt::format(R"({{"schema":{{"name":"{}","version":{}}},)", checkpoint_schema, checkpoint_version);
}

std::string words(const nlohmann::json& value) {
  return value.is_string() ? detp::quoted(value.get<std::string>()) : value.dump();
}

/// What the two differ in; empty if they are equal.
std::string difference(const nlohmann::json& found, const nlohmann::json& wanted) {
  for (const bool digests : {false, true})  // a digest says less than a number
    for (const auto& [name, value] : wanted.items()) {
      if (name.starts_with("digest") != digests) continue;
      if (!found.contains(name)) return fmt::format("was made without {}", name);
      if (found.at(name) != value)
        return fmt::format("was made with {} {}, not {}", name, words(found.at(name)), words(value));
    }
  return found.size() == wanted.size() ? "" : "was made with other options";
}

}  // namespace

CheckpointFile::CheckpointFile(std::filesystem::path path, std::string work, nlohmann::json key)
    : path_(std::move(path)), work_(std::move(work)), key_(std::move(key)) {}

sim::FileError CheckpointFile::damaged(const std::string& why) const {
  return {path_.string(), fmt::format("is not a checkpoint: {}", shortened(why, 150))};
}

std::optional<nlohmann::json> CheckpointFile::read(std::stop_token stop) const {
  std::error_code unknown;  // other errors appear when the file is read
  if (!std::filesystem::exists(path_, unknown) && !unknown) return std::nullopt;
  try {
    nlohmann::json json = nlohmann::json::parse(sim::read_file(path_.string(), most_checkpoint_bytes, std::move(stop)));
    if (json.at("schema").at("name") != checkpoint_schema || json.at("schema").at("version") != checkpoint_version)
      throw sim::FileError(path_.string(), "is not a checkpoint of this version of detp");
    if (json.at("checksum") != checksum(json.at("work"), json.at("key"), json.at("state")))
      throw damaged("it was altered, and does not fit its checksum");
    if (json.at("work") != work_)
      throw sim::FileError(path_.string(),
                           fmt::format("is a checkpoint of {}, not of {}", words(json.at("work")), work_));
    if (const std::string other = difference(json.at("key"), key_); !other.empty())
      throw sim::FileError(path_.string(), other + "; start again without it");
    return std::move(json.at("state"));
  } catch (const nlohmann::json::exception& error) {
    throw damaged(error.what());
  }
}

void CheckpointFile::write(const nlohmann::json& state) {
  const sim::Stopwatch watch;
  sim::OutputFile file(path_.string());
  file.write(head() + fmt::format(R"("checksum":"{}","work":{},"key":{},"state":)", checksum(work_, key_, state),
                                  nlohmann::json(work_).dump(), key_.dump()));
  file.write(state.dump());
  file.write("}\n");
  file.commit();
  write_seconds_ = watch.seconds();
  since_last_ = {};
}

void require_replaceable(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown) || std::filesystem::is_empty(path, unknown)) return;
  sim::InputFile file(path);
  static_cast<void>(file.fetch(head().size()));
  if (!file.buffered().starts_with(head()))
    throw sim::FileError(path,
                         "would be replaced, but is not a checkpoint of this version of detp; delete it, or give "
                         "--checkpoint another file");
}

bool CheckpointFile::due() const {
  return since_last_.seconds() > std::max(first_seconds, times_cheaper * write_seconds_);
}

}  // namespace detp::validate
