#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>

/// Processes that work together: what a search on ranks needs of them.
namespace detp::sim {

class Ranks {
 public:
  virtual ~Ranks() = default;

  [[nodiscard]] virtual int rank() const = 0;   ///< of this process, from 0
  [[nodiscard]] virtual int count() const = 0;  ///< at least 1

  /// Waits until the bytes may be changed. What one rank sends to another arrives in the same order.
  virtual void send(std::span<const std::byte> bytes, int to) = 0;
  /// Waits for so many bytes.
  virtual void receive(std::span<std::byte> bytes, int from) = 0;

  /// This rank failed: the others may stop what they do. They hear of the failure itself later.
  virtual void alert() {}

  template <class T>
  void send_all(std::span<const T> values, int to) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!values.empty()) send(std::as_bytes(values), to);
  }
  template <class T>
  void receive_all(std::span<T> values, int from) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!values.empty()) receive(std::as_writable_bytes(values), from);
  }
  template <class T>
  void send_one(const T& value, int to) {
    send_all(std::span<const T>(&value, 1), to);
  }
  template <class T>
  [[nodiscard]] T receive_one(int from) {
    T value;
    receive_all(std::span<T>(&value, 1), from);
    return value;
  }
};

inline void send_text(Ranks& ranks, const std::string& text, int to) {
  ranks.send_one(text.size(), to);
  ranks.send_all(std::span(text.data(), text.size()), to);
}

[[nodiscard]] inline std::string receive_text(Ranks& ranks, int from) {
  std::string text(ranks.receive_one<std::size_t>(from), ' ');
  ranks.receive_all(std::span(text.data(), text.size()), from);
  return text;
}

/// A process alone.
class OneRank final : public Ranks {
 public:
  [[nodiscard]] int rank() const override { return 0; }
  [[nodiscard]] int count() const override { return 1; }
  void send(std::span<const std::byte>, int) override { throw std::logic_error("there is no other rank"); }
  void receive(std::span<std::byte>, int) override { throw std::logic_error("there is no other rank"); }
};

}  // namespace detp::sim
