#pragma once

#include <type_traits>
#include <utility>

namespace detp::sim {

template <class Signature>
class FunctionRef;

/// A reference to a callable, for a parameter that a function calls only before it returns. Unlike std::function, it
/// allocates no memory.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class Callable>
  requires(std::is_invocable_r_v<Result, const Callable&, Arguments...> && !std::is_same_v<Callable, FunctionRef>)
      FunctionRef(const Callable& callable)  // NOLINT: implicit, as std::function
      : callable_(&callable), call_([](const void* borrowed, Arguments... arguments) -> Result {
          return (*static_cast<const Callable*>(borrowed))(std::forward<Arguments>(arguments)...);
        }) {}

  Result operator()(Arguments... arguments) const { return call_(callable_, std::forward<Arguments>(arguments)...); }

 private:
  const void* callable_;
  Result (*call_)(const void*, Arguments...);
};

}  // namespace detp::sim
