// Remembered plans: reading never throws, and warns if it uses nothing. What was read can be written and read again.

#include "detp/validate/choice/plan_memory_file.hpp"

#include "scratch.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace detp::validate;
  // The key of this machine follows the schema, so that most inputs are not refused because of another key.
  PlanMemory memory;
  static const std::string of_nothing = plan_memory_text(memory);
  static const std::string until_plans = of_nothing.substr(0, of_nothing.find("[]"));
  std::string text(detp::fuzz::text_of(data, size));
  if (text.starts_with("[")) text = until_plans + text + "}";
  const std::string warning = parse_plan_memory(text, "plans.json", memory);
  if (!warning.empty() && memory.size() > 0) std::abort();
  PlanMemory again;
  if (!parse_plan_memory(plan_memory_text(memory), "plans.json", again).empty()) std::abort();
  if (again.entries() != memory.entries()) std::abort();
  return 0;
}
