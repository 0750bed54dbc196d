#include "scratch.hpp"

#include <algorithm>
#include <bit>
#include <new>

#include "page_pool.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t cache_line = 64;  // bytes; the smallest size

/// Number of the size class of a request. The classes are 64 bytes, then four per octave: 80, 96, 112, 128, 160, …
std::size_t class_of(std::size_t bytes) {
  if (bytes <= cache_line) return 0;
  const auto octave = static_cast<std::size_t>(std::bit_width(bytes - 1)) - 1;  // 2^octave < bytes <= 2^(octave + 1)
  return 4 * (octave - 6) + ((bytes - 1) >> (octave - 2) & 3) + 1;
}

/// Bytes of the blocks of a class.
std::size_t size_of_class(std::size_t number) {
  if (number == 0) return cache_line;
  const std::size_t octave = (number - 1) / 4 + 6;
  return (std::size_t{1} << octave) + ((number - 1) % 4 + 1) * (std::size_t{1} << (octave - 2));
}

}  // namespace

void Scratch::begin() {
  if (held_ > 2 * most_used_) release();
  most_used_ = used_;
}

void Scratch::release() {
  for (std::size_t number = 0; number < sizes; ++number)
    while (Free* const block = free_[number]) {
      free_[number] = block->next;
      held_ -= size_of_class(number);
      page_pool().deallocate(block, size_of_class(number), cache_line);
    }
}

void* Scratch::do_allocate(std::size_t bytes, std::size_t alignment) {
  if (alignment > cache_line) throw std::bad_alloc();
  const std::size_t number = class_of(bytes);
  if (number >= sizes) throw std::bad_alloc();
  const std::size_t size = size_of_class(number);
  const std::lock_guard lock(mutex_);
  void* block = free_[number];
  if (block != nullptr) {
    free_[number] = free_[number]->next;
  } else {
    block = page_pool().allocate(size, cache_line);
    held_ += size;
  }
  used_ += size;
  most_used_ = std::max(most_used_, used_);
  return block;
}

void Scratch::do_deallocate(void* block, std::size_t bytes, std::size_t) {
  const std::size_t number = class_of(bytes);
  const std::lock_guard lock(mutex_);
  free_[number] = new (block) Free{free_[number]};
  used_ -= size_of_class(number);
}

}  // namespace detp::sim
