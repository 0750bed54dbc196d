#include "memory.hpp"

#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace detp::sim {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

std::atomic<double> limit_set{0};  // 0: no limit set

double physical_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double resource_limit(int resource) {
  rlimit limit{};
  const bool known = getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) == 0;
  return known && limit.rlim_cur != RLIM_INFINITY ? static_cast<double>(limit.rlim_cur) : no_limit;
}

/// The limit in a file. Returns no_limit if the file does not exist or holds no positive number. (A group without a
/// limit has the word "max" in its file.)
double limit_in(const std::filesystem::path& path) {
  std::ifstream file(path);
  double limit = 0;
  return file >> limit && limit > 0 ? limit : no_limit;
}

/// The smallest limit in the files of that name, in the group's folder and in the folders above it.
double least_limit(const std::filesystem::path& root, const std::filesystem::path& group, const char* file) {
  double least = limit_in(root / file);
  std::filesystem::path folder = root;
  for (const auto& part : group.relative_path()) {
    folder /= part;
    least = std::min(least, limit_in(folder / file));
  }
  return least;
}

std::string content_of(const char* path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

double environment_limit() {
  const char* text = std::getenv("DETP_MEMORY_LIMIT");
  if (text == nullptr || *text == '\0') return 0;
  try {
    return parse_bytes(text);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("environment variable DETP_MEMORY_LIMIT: {}", error.what()));
  }
}

/// The limit that was set (by set_memory_limit or the environment), or 0.
double explicit_limit() {
  static const double environment = environment_limit();
  const double set = limit_set;
  return set > 0 ? set : environment;
}

}  // namespace

double cgroup_limit(const std::string& own_groups, const std::string& root) {
  double least = no_limit;
  std::istringstream lines(own_groups);
  for (std::string line; std::getline(lines, line);) {  // number:controllers:path
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    const std::filesystem::path group = line.substr(second + 1);
    if (controllers == ",,") least = std::min(least, least_limit(root, group, "memory.max"));
    if (controllers.find(",memory,") != std::string::npos)
      least = std::min(least, least_limit(std::filesystem::path(root) / "memory", group, "memory.limit_in_bytes"));
  }
  return least;
}

double machine_memory() {
  static const double memory =
      std::min({physical_memory(), cgroup_limit(content_of("/proc/self/cgroup"), "/sys/fs/cgroup"),
                resource_limit(RLIMIT_AS), resource_limit(RLIMIT_DATA)});
  return memory;
}

double memory_budget() {
  const double set = explicit_limit();
  return set > 0 ? set : machine_memory() / 2;
}

void set_memory_limit(std::optional<double> bytes) {
  if (bytes && !(*bytes > 0 && std::isfinite(*bytes)))
    throw std::invalid_argument(fmt::format("memory limit must be > 0 and finite (got {})", *bytes));
  limit_set = bytes.value_or(0);
}

bool memory_limit_is_set() { return explicit_limit() > 0; }

double parse_bytes(std::string_view text) {
  constexpr std::string_view units = "KMGT";
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  double factor = 1;
  if (!unit.empty() && units.find(unit[0]) != std::string_view::npos) {
    factor = std::exp2(10 * (static_cast<double>(units.find(unit[0])) + 1));
    unit.remove_prefix(1);
  }
  if (error != std::errc{} || !unit.empty() || !(value > 0 && value * factor < 1e30))
    throw std::invalid_argument(
        fmt::format("must be a size such as 4G, 512M or a number of bytes > 0 (got '{}')", text.substr(0, 60)));
  return value * factor;
}

double grown_bytes(std::size_t count, std::size_t element) {
  return count == 0 ? 0 : static_cast<double>(std::bit_ceil(count)) * static_cast<double>(element);
}

void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void require_memory(std::string_view what, double bytes) {
  const double budget = memory_budget();
  if (bytes <= budget) return;
  const bool set = memory_limit_is_set();
  throw std::length_error(fmt::format("{} would take {:.3g} GB, more than {} ({:.3g} GB)", what, bytes / 1e9,
                                      set ? "the memory limit" : "half of the memory that this process may have",
                                      (set ? 1 : 2) * budget / 1e9));
}

OutOfMemory::OutOfMemory(std::string_view doing) {
  constexpr std::string_view start = "out of memory while ";
  const std::size_t kept = std::min(doing.size(), sizeof(message_) - start.size() - 1);
  char* end = std::copy(start.begin(), start.end(), message_);
  end = std::copy_n(doing.begin(), kept, end);
  *end = '\0';
}

}  // namespace detp::sim
