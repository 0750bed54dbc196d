#include "allocations.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>

#include "machine.hpp"

namespace {

thread_local std::uint64_t calls = 0;

}  // namespace

std::uint64_t detp::support::allocations() { return calls; }

#ifndef DETP_SANITIZED
namespace {

void* counted(std::size_t bytes, std::size_t alignment) {
  ++calls;
  void* const block = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}

}  // namespace

void* operator new(std::size_t bytes) { return counted(bytes > 0 ? bytes : 1, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }
#endif
