#pragma once

#include <doctest/doctest.h>
#include <tbb/parallel_for.h>
#if defined(__SSE__)
#include <immintrin.h>
#endif

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/sim/lists/simd/list_search.hpp"

/// What tests ask of the machine and of the build.
namespace detp::support {

// DETP_SANITIZED is defined in a build with a sanitizer, which needs additional memory and time.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DETP_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DETP_SANITIZED
#endif
#endif

#ifdef DETP_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

// The floating-point mode of code that flushes subnormal numbers to zero, as many renderers and Embree do.

/// While it exists, its thread flushes subnormal numbers to zero, as arguments and as results.
class Flushing {
 public:
  Flushing() { set_control(before_ | flushing); }
  ~Flushing() { set_control(before_); }
  Flushing(const Flushing&) = delete;
  Flushing& operator=(const Flushing&) = delete;

 private:
#if defined(__SSE__)
  static constexpr std::uint64_t flushing = 0x8040;
  static std::uint64_t control() { return _mm_getcsr(); }
  static void set_control(std::uint64_t value) { _mm_setcsr(static_cast<unsigned>(value)); }
#elif defined(__aarch64__)
  static constexpr std::uint64_t flushing = std::uint64_t{1} << 24;
  static std::uint64_t control() {
    std::uint64_t value = 0;
    asm volatile("mrs %0, fpcr" : "=r"(value));
    return value;
  }
  static void set_control(std::uint64_t value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
#endif
  std::uint64_t before_ = control();
};

/// Whether this thread loses a subnormal number.
inline bool flushes() {
  volatile double tiny = 1e-310;
  tiny = tiny * 0.5;
  volatile double zero = 0;
  return !(tiny > zero);
}

/// Calls check() with each instruction set that the machine has.
template <class Check>
void with_each_instruction_set(const Check& check) {
  for (const sim::stream::InstructionSet& set : sim::stream::compiled_instruction_sets()) {
    if (!set.here) continue;
    const sim::stream::OnlyInstructionSet only(set.name);
    CAPTURE(set.name);
    REQUIRE(sim::stream::instruction_set() == set.name);
    check();
  }
}

/// The vector of one(0) … one(count - 1), computed on all cores.
template <class One>
auto in_parallel(std::size_t count, const One& one) {
  std::vector<decltype(one(count))> results(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { results[i] = one(i); });
  return results;
}

/// Sets the memory limit, and restores the default.
struct MemoryLimit {
  explicit MemoryLimit(double bytes) { sim::set_memory_limit(bytes); }
  ~MemoryLimit() { sim::set_memory_limit(std::nullopt); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;
};

}  // namespace detp::support
