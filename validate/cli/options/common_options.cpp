#include "common_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/files/output_place.hpp"
#include "detp/sim/files/table_writer.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "detp/validate/cli/text/messages.hpp"

namespace detp::cli {
namespace {

using Suffixes = std::vector<std::string_view>;

/// An option that names a file which the command writes.
struct OutputOption {
  const char* name;
  Suffixes suffixes = {};  ///< of its formats; empty: the file is detp's own and may have any that is not `taken`
};

const std::vector<OutputOption>& output_options() {
  static const std::vector<OutputOption> all{{"--per-disc", {".csv", ".ply", ".vtp", ".npy"}},
                                             {"--per-face", {".csv", ".ply", ".vtp", ".npy"}},
                                             {"--pairs", {".csv"}},
                                             {"--picture", {".png", ".svg"}},
                                             {"--write-mesh", {".ply"}},
                                             {"--write-discs", {".csv", ".ply", ".npy"}},
                                             {"--write-rays", {".csv", ".ply", ".npy"}},
                                             {"--reference"},
                                             {"--checkpoint"},
                                             {"--sweep-rows", {".csv"}}};
  return all;
}

constexpr auto input_options = {"SCENE", "--discs", "--ray-file", "--calibration"};

/// Suffixes of formats that other files have.
const Suffixes taken{".csv", ".ply",  ".npy", ".npz", ".mcpl", ".vtp",  ".obj", ".mtl",
                     ".stl", ".gltf", ".glb", ".svg", ".png",  ".html", ".htm"};

/// A file that the options name, and how.
struct NamedFile {
  std::string option;
  std::string path;
};

bool is_among(const std::string& suffix, const Suffixes& suffixes) {
  return std::ranges::find(suffixes, suffix) != suffixes.end();
}

/// The value of the option; empty if it is not given, or the command has none of this name.
std::string value_of(const CLI::App& command, const std::string& option) {
  const CLI::Option* found = command.get_option_no_throw(option);
  return found == nullptr || found->count() == 0 ? "" : found->results().front();
}

bool is_given(const CLI::App& command, const std::string& option) {
  const CLI::Option* found = command.get_option_no_throw(option);
  return found != nullptr && found->count() > 0;
}

void require_suffix(const NamedFile& file, const Suffixes& suffixes) {
  const std::string suffix = sim::suffix_of(file.path);
  if (suffix.empty() || is_among(suffix, suffixes)) return;
  throw std::invalid_argument(fmt::format("{} writes {}: the file's name must end so, or have no suffix (got {})",
                                          file.option, fmt::join(suffixes, ", "), shown_path(file.path)));
}

void require_own_suffix(const NamedFile& file) {
  const std::string suffix = sim::suffix_of(file.path);
  if (is_among(suffix, taken))
    throw std::invalid_argument(
        fmt::format("{} writes a file of detp's own, which is not {}; give another name than {}", file.option, suffix,
                    shown_path(file.path)));
}

std::vector<NamedFile> outputs_of(const CLI::App& command, const CommonOptions& common) {
  std::vector<NamedFile> outputs;
  if (common.output) outputs.push_back({"--output", *common.output});
  for (const OutputOption& one : output_options()) {
    const NamedFile file{one.name, value_of(command, one.name)};
    if (file.path.empty()) continue;
    one.suffixes.empty() ? require_own_suffix(file) : require_suffix(file, one.suffixes);
    outputs.push_back(file);
  }
  return outputs;
}

std::vector<NamedFile> inputs_of(const CLI::App& command) {
  std::vector<NamedFile> inputs;
  for (const std::string option : input_options)
    if (const std::string path = value_of(command, option); !path.empty()) inputs.push_back({option, path});
  std::erase_if(inputs, [](const NamedFile& one) {
    return one.option == "SCENE" ? one.path.starts_with('@') : one.path == "none" || one.path == "auto";
  });
  if (command.get_option_no_throw("--calibration") != nullptr &&
      !std::ranges::count(inputs, "--calibration", &NamedFile::option))
    inputs.push_back({"the stored calibration", validate::default_calibration_path()});
  return inputs;
}

bool is_file(const std::string& path) {
  std::error_code unknown;
  return std::filesystem::is_regular_file(path, unknown);
}

void require_apart(const NamedFile& output, const std::string& input, const std::string& what) {
  if (is_file(input) && sim::same_place(output.path, input))
    throw std::invalid_argument(
        fmt::format("{} would replace {}, {}; give another file", output.option, shown_path(input), what));
}

/// Also the materials of a mesh, which are only looked for if an output could be among them.
void require_apart(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs,
                   const std::stop_token& stop) {
  for (const NamedFile& output : outputs)
    for (const NamedFile& input : inputs)
      require_apart(output, input.path, input.option.starts_with("the") ? input.option : "the file of " + input.option);
  if (std::ranges::count(inputs, "-", &NamedFile::path) > 1)
    throw std::invalid_argument("only one input can be standard input (-)");
  const bool some_exist = std::ranges::any_of(outputs, is_file, &NamedFile::path);
  for (const NamedFile& input : inputs)
    if (some_exist && input.option == "SCENE" && is_file(input.path))
      for (const std::string& part : sim::files_of_mesh(input.path, stop))
        for (const NamedFile& output : outputs) require_apart(output, part, "a part of " + shown_path(input.path));
}

void require_apart(const std::vector<NamedFile>& outputs) {
  for (auto first = outputs.begin(); first != outputs.end(); ++first)
    for (auto second = first + 1; second != outputs.end(); ++second)
      if (sim::same_place(first->path, second->path))
        throw std::invalid_argument(fmt::format("{} and {} name the same file {}; each needs its own", first->option,
                                                second->option, shown_path(second->path)));
}

}  // namespace

Screen CommonOptions::screen() const {
  return output ? Screen{.width = 0, .colour = colour == Colour::always} : screen_of(STDOUT_FILENO, colour);
}

void note(const CommonOptions& common, const std::string& message) {
  if (common.quiet) return;
  const Screen screen = screen_of(STDERR_FILENO, common.colour);
  const bool warning = message.starts_with("warning: ");
  const char* const wipe = isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";  // erases the progress line
  std::string text = escaped(message) + "\n";
  if (screen.width > 0) text = wrapped(escaped(message), screen.width, 2);  // a terminal; elsewhere a line stays one
  write_error(wipe + styled(screen, warning ? Style::doubtful : Style::plain, text));
}

void settle_format(const CLI::App& command, CommonOptions& common) {
  if (!common.output) return;
  const NamedFile file{"--output", *common.output};
  if (command.get_name() == "report") return require_suffix(file, {".html", ".htm"});
  if (command.get_name() == "calibrate") return require_suffix(file, {".json"});
  const std::string suffix = sim::suffix_of(file.path);
  const bool map = is_given(command, "--map");
  if (suffix.empty() || (map && suffix == ".svg")) return;
  const std::string format = suffix == ".txt" ? "text" : suffix.substr(1);
  const bool known = format == "text" || format == "json" || format == "csv";
  if (!is_given(command, "--format")) {
    require_suffix(file, map ? Suffixes{".txt", ".json", ".csv", ".svg"} : Suffixes{".txt", ".json", ".csv"});
    common.format = format;
  } else if ((known && format != "text" && format != common.format) || (!known && is_among(suffix, taken))) {
    throw std::invalid_argument(
        fmt::format("--format {} contradicts the suffix of --output {}; leave out --format, or "
                    "give another name",
                    common.format, shown_path(file.path)));
  }
}

bool writes_output(const CLI::App& command) {
  const std::string name = command.get_name();
  const bool picture = is_given(command, "--map") && sim::suffix_of(value_of(command, "--output")) == ".svg";
  return name == "report" || name == "calibrate" || picture;
}

void check_files(const CLI::App& command, const CommonOptions& common, const std::stop_token& stop) {
  const std::vector<NamedFile> outputs = outputs_of(command, common);
  for (const NamedFile& output : outputs) sim::require_writable(output.path);
  require_apart(outputs);
  std::vector<NamedFile> written = outputs;
  if (!common.output) written.push_back({"standard output", "/dev/stdout"});
  require_apart(written, inputs_of(command), stop);
  const std::string checkpoint = value_of(command, "--checkpoint");
  const bool resume = is_given(command, "--resume");
  if (resume && checkpoint.empty())
    throw std::invalid_argument("--resume needs the --checkpoint FILE to continue from");
  if (!resume && !checkpoint.empty()) validate::require_replaceable(checkpoint);
}

}  // namespace detp::cli
