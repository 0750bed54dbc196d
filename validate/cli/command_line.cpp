#include "command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "envelope.hpp"

namespace detp::cli {
namespace {

constexpr std::string_view columns_of_files = R"(
Files: CSV with a heading, PLY with these properties, or NPY (structured, or the columns in this order).
  discs  x,y,z,nx,ny,nz and, if wanted, radius (or --disc-radius)
  rays   ox,oy,oz,dx,dy,dz and, if wanted, length (inf or none: a line in both directions), power (1), photon
         (pieces of one path share a whole number), landing (distance to the surface that was met)
Units: lengths as in the scene. Irradiance is the rays' power over area. Ke of a material is the radiance of its front,
  a light's power is Ke times pi times its area.
)";

/// A line for each field of an answer: its name in JSON, what it means, and its columns in CSV if they have other names.
std::string help_of_fields(const std::vector<validate::FieldText>& fields, std::size_t width) {
  constexpr std::size_t indent = 26;
  std::string text =
      "JSON has these fields besides inputs, provenance and stopped (before the end), CSV columns of the same "
      "names:\n\n";
  for (const validate::FieldText& field : fields) {
    const bool in_json = !field.name.empty();
    std::string line =
        fmt::format("  {:<{}} {}", in_json ? field.name : field.columns.front(), indent - 3, field.meaning);
    if (!field.unit.empty()) line += fmt::format(" ({})", field.unit);
    if (field.columns.empty()) line += "; in JSON alone";
    if (!in_json) line += "; in CSV alone";
    if (field.columns.size() > 8)
      line += fmt::format("; columns {}, {} … {}", field.columns[0], field.columns[1], field.columns.back());
    else if (in_json && !field.columns.empty() && field.columns != validate::Columns{field.name})
      line += fmt::format("; columns {}", fmt::join(field.columns, ", "));
    text += wrapped(line, width, indent);
  }
  return text;
}

/// The help of a command: short, with all options, or the fields of its answer.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpKind kind = HelpKind::brief;
  std::span<const Command> commands = {};

  std::string make_help(const CLI::App* command, std::string name, CLI::AppFormatMode mode) const override {
    const std::string_view brief = short_help(command->get_name());
    if (brief.empty()) return CLI::Formatter::make_help(command, std::move(name), mode);
    if (kind == HelpKind::brief) return std::string(brief);
    if (kind == HelpKind::fields) {
      const auto found = std::ranges::find(commands, command, &Command::app);
      return help_of_fields(found->fields, width_);
    }
    const bool reads = command->get_option_no_throw("--discs") != nullptr;
    return CLI::Formatter::make_help(command, std::move(name), mode) + std::string(reads ? columns_of_files : "");
  }

  std::string make_option(const CLI::Option* option, bool positional) const override {
    const std::size_t column = get_column_width();
    std::string name = "  " + make_option_name(option, positional) + make_option_opts(option);
    std::string start;
    if (name.size() < column)
      name.resize(column, ' ');
    else
      start = std::exchange(name, std::string(column, ' ')) + "\n";
    std::istringstream paragraphs(make_option_desc(option));
    std::string lines;
    for (std::string paragraph; std::getline(paragraphs, paragraph); name = std::string(column, ' '))
      lines += wrapped(name + paragraph, width_, column);
    return start + (lines.empty() ? name + "\n" : lines);
  }

 private:
  std::size_t width_ = screen_of(STDOUT_FILENO, Colour::never).text_width();
};

void add_common_options(CLI::App& command, CommonOptions& common) {
  command.add_option("--format", common.format, "text, json or csv; default: text")
      ->check(CLI::IsMember({"text", "json", "csv"}));
  command
      .add_option_function<std::string>(
          "--color",
          [&common](const std::string& when) {
            common.colour = when == "always" ? Colour::always : when == "never" ? Colour::never : Colour::automatic;
          },
          "colours in text: always, never, or auto: on a terminal, unless NO_COLOR is set; default: auto")
      ->check(CLI::IsMember({"auto", "always", "never"}));
  command.add_option("-o,--output", common.output, "write the result to a file; default: stdout");
  command.add_flag("--quiet", common.quiet, "no notices, no progress");
  command
      .add_option_function<std::string>(
          "--seed", [&common](const std::string& text) { common.seed = parse_seed("--seed", text); },
          "of everything random; default: 1")
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--threads",
          [&common](const std::string& text) {
            common.threads = static_cast<int>(parse_whole("--threads", text, 0, sim::most_threads));
          },
          "at most so many; default: all cores")
      ->type_name("N");
  command
      .add_option("--memory-limit", common.memory_limit,
                  "refuse work that would take more, as 4G; default: half of the memory that detp may have")
      ->type_name("SIZE");
  add_number(command, "--time-limit", common.time_limit,
             "stop after that many seconds and show what there is; default: no limit");
}

}  // namespace

CommandLine::CommandLine()
    : program_("Predicts, runs and checks techniques that find which rays cross which discs.", "detp"),
      commands_{model_command(program_),     choose_command(program_),   run_command(program_),
                validate_command(program_),  scene_command(program_),    bench_command(program_),
                calibrate_command(program_), accuracy_command(program_), report_command(program_)} {
  program_.set_version_flag("-V,--version", "detp " DETP_VERSION);
  // 0 is allowed, because otherwise the parser would report an unknown command as a missing command.
  program_.require_subcommand(0, 1);
  const auto formatter = std::make_shared<HelpFormatter>();
  help_ = &formatter->kind;
  formatter->commands = commands_;
  program_.formatter(formatter);
  program_.footer(
      "detp help COMMAND explains a command and its options that matter most, detp help COMMAND all every option.");
  for (const Command& command : commands_) {
    add_common_options(*command.app, common_);
    command.app->formatter(formatter);
  }
}

const Command& CommandLine::parse(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (*argv[i] == '\0')  // the parser would treat an empty value as absent, for instance --rays "$n" if n is not set
      throw std::invalid_argument(fmt::format("argument {} is empty, after {}; give it a value", i, argv[i - 1]));
  std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  if (!arguments.empty() && arguments.front() == "help") {
    arguments.front() = "--help";
    if (arguments.size() > 1) std::swap(arguments[0], arguments[1]);
  }
  const auto help =
      std::ranges::find_if(arguments, [](const std::string& one) { return one == "--help" || one == "-h"; });
  if (help != arguments.end() && std::next(help) != arguments.end()) {
    const std::string& what = *std::next(help);
    *help_ = what == "all" ? HelpKind::all : what == "fields" ? HelpKind::fields : HelpKind::brief;
    if (*help_ != HelpKind::brief) arguments.erase(std::next(help));
  }
  if (!arguments.empty() && !arguments.front().starts_with('-')) require_command(arguments.front());
  std::reverse(arguments.begin(), arguments.end());  // the parser expects the reverse order
  program_.parse(std::move(arguments));
  for (const Command& command : commands_)
    if (command.app->parsed()) return command;
  throw std::invalid_argument(fmt::format("a command is needed: {}", names()));
}

std::string CommandLine::message(const CLI::ParseError& error) const {
  std::string text = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return text;
  for (const Command& command : commands_)
    for (const std::string& extra : command.app->remaining()) {
      if (!command.app->parsed() || !extra.starts_with("--")) continue;
      std::vector<std::string> names;
      for (const CLI::Option* option : command.app->get_options()) names.push_back("--" + option->get_single_name());
      const std::vector<std::string_view> known(names.begin(), names.end());
      return text + did_you_mean(std::string_view(extra).substr(0, extra.find('=')), known);
    }
  return text;
}

std::string CommandLine::overview() const {
  std::string text = program_.get_description() + "\n\n";
  for (const Command& command : commands_)
    text += fmt::format("  {:<10} {}\n", command.app->get_name(), command.app->get_description());
  return text +
         "\nExample: detp choose @tree --rays 100k --disc-radius 1%\n"
         "detp help COMMAND explains a command and its options.\n";
}

std::string CommandLine::names() const {
  std::string list;
  for (const Command& command : commands_)
    list += (list.empty() ? "" : &command == &commands_.back() ? " or " : ", ") + command.app->get_name();
  return list + " (detp --help tells more)";
}

void CommandLine::require_command(const std::string& name) const {
  std::vector<std::string_view> known;
  for (const Command& command : commands_) known.emplace_back(command.app->get_name());
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw std::invalid_argument(fmt::format("there is no command {}; there are {}{}", detp::quoted(name),
                                            fmt::join(known, ", "), did_you_mean(name, known)));
}

namespace {

AskedRun answer_of(const std::vector<std::string>& words, bool in_memory, const std::stop_token& stop) {
  std::vector<std::string> all{"detp"};
  all.insert(all.end(), words.begin(), words.end());
  all.emplace_back("--quiet");
  std::vector<char*> arguments;
  for (std::string& word : all) arguments.push_back(word.data());
  CommandLine line;
  try {
    const Command& command = line.parse(static_cast<int>(arguments.size()), arguments.data());
    CommonOptions common = line.common();
    common.in_memory = in_memory;
    if (common.memory_limit) throw std::invalid_argument("--memory-limit is for the command alone");
    if (common.time_limit != 0)
      throw std::invalid_argument("--time-limit is for the command alone; stop the call instead");
    settle_format(*command.app, common);
    if (common.output && !writes_output(*command.app))
      throw std::invalid_argument("--output is for the command alone: the answer is returned");
    check_files(*command.app, common, stop);
    common.format = "json";  // some commands make nothing else then
    Result result = command.run(common, stop);
    result.json["stopped"] = result.stopped.has_value();
    return {envelope(command.app->get_name(), common, sim::thread_count(common.threads), result),
            std::move(result.run)};
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0)
      throw std::invalid_argument("--help and --version are for the command alone; ask a question, as model");
    throw std::invalid_argument(line.message(error));
  }
}

}  // namespace

Json ask(const std::vector<std::string>& words, const std::stop_token& stop) {
  if (words.empty()) throw std::invalid_argument("a command is needed, as model");
  return answer_of(words, false, stop).json;
}

AskedRun ask_run(std::vector<std::string> words, const std::stop_token& stop) {
  words.insert(words.begin(), "run");
  return answer_of(words, true, stop);
}

}  // namespace detp::cli
