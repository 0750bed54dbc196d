#include "calibration.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/lists/simd/list_search.hpp"

namespace detp::validate {
namespace {

constexpr int cost_model = 11;  // change it whenever the meaning of a unit cost or of a count changes

std::string cpu_name() {
  std::ifstream cpus("/proc/cpuinfo");
  for (std::string line; std::getline(cpus, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) return line.substr(line.find(": ") + 2);
  return "unknown";
}

/// Calls visit(name in JSON, name in words, member) for each member of a key.
template <class Visit>
void for_each_member(const Visit& visit) {
  visit("cpu", "cpu", &CalibrationKey::cpu);
  visit("instruction_set", "instruction set", &CalibrationKey::instruction_set);
  visit("caches", "cache sizes", &CalibrationKey::caches);
  visit("threads", "number of threads", &CalibrationKey::threads);
  visit("compiler", "compiler", &CalibrationKey::compiler);
  visit("cost_model", "version of the cost model", &CalibrationKey::cost_model);
}

}  // namespace

CalibrationKey this_machine() {
  return {.cpu = cpu_name(),
          .instruction_set = sim::stream::instruction_set(),
          .caches = fmt::format("{} {} {}", sysconf(_SC_LEVEL1_DCACHE_SIZE), sysconf(_SC_LEVEL2_CACHE_SIZE),
                                sysconf(_SC_LEVEL3_CACHE_SIZE)),
          .threads = static_cast<int>(std::thread::hardware_concurrency()),
          .compiler = __VERSION__,
          .cost_model = cost_model};
}

std::string difference(const CalibrationKey& stored, const CalibrationKey& here) {
  std::string first;
  for_each_member([&](const char* /*name*/, const char* what, auto member) {
    if (first.empty() && stored.*member != here.*member)
      first = shortened(fmt::format("its {} is {}, here it is {}", what, stored.*member, here.*member), 300);
  });
  return first;
}

nlohmann::ordered_json to_json(const CalibrationKey& key) {
  nlohmann::ordered_json json;
  for_each_member([&](const char* name, const char* /*what*/, auto member) { json[name] = key.*member; });
  return json;
}

CalibrationKey key_of(const nlohmann::ordered_json& json) {
  CalibrationKey key;
  for_each_member([&](const char* name, const char* /*what*/, auto member) { json.at(name).get_to(key.*member); });
  return key;
}

std::string CalibrationQuality::doubt() const {
  std::string why;
  if (probe) return why;
  if (left_out_median_error > doubtful_error)
    why = fmt::format("its median error is {:.2g} %, more than {:.2g} %", 100 * left_out_median_error,
                      100 * doubtful_error);
  if (processor_share < doubtful_share)
    why += fmt::format("{}other programs took {:.2g} % of the time of its runs", why.empty() ? "" : "; ",
                       100 * (1 - processor_share));
  return why;
}

double CalibrationQuality::relative_error() const {
  constexpr double median_of_normal = 0.6745;  // of |x|, in standard deviations
  return std::max(left_out_median_error / median_of_normal, 1 - processor_share);
}

bool CalibrationQuality::is_better_than(const CalibrationQuality& other) const {
  if (probe != other.probe) return other.probe;
  if (doubt().empty() != other.doubt().empty()) return doubt().empty();
  return relative_error() < other.relative_error();
}

}  // namespace detp::validate
