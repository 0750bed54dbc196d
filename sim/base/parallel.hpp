#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <cstddef>
#include <utility>

#include "floating_point.hpp"

/// oneTBB's algorithms, with each task in the default floating-point mode. No other file calls oneTBB's own: the test
/// `layers` checks this. Call them as sim::parallel_for and so on, because the plain name may also find oneTBB's.
namespace detp::sim {

using ParallelRange = oneapi::tbb::blocked_range<std::size_t>;

/// Calls body(part) for parts of the range.
template <class Body>
void parallel_for(const ParallelRange& range, const Body& body) {
  oneapi::tbb::parallel_for(range, [&body](const ParallelRange& part) {
    const DefaultFloatingPoint mode;
    body(part);
  });
}

/// Calls body(i) for i = first … last - 1.
template <class Number, class Body>
void parallel_for(Number first, Number last, const Body& body) {
  oneapi::tbb::parallel_for(first, last, [&body](Number i) {
    const DefaultFloatingPoint mode;
    body(i);
  });
}

/// Joins the values of body(part, identity or the value of earlier parts) by join(a, b).
template <class Value, class Body, class Join>
Value parallel_reduce(const ParallelRange& range, const Value& identity, const Body& body, const Join& join) {
  return oneapi::tbb::parallel_reduce(
      range, identity,
      [&body](const ParallelRange& part, Value before) {
        const DefaultFloatingPoint mode;
        return body(part, std::move(before));
      },
      [&join](const Value& a, const Value& b) {
        const DefaultFloatingPoint mode;
        return join(a, b);
      });
}

/// Calls both, perhaps at the same time.
template <class First, class Second>
void parallel_invoke(const First& first, const Second& second) {
  const auto in_default_mode = [](const auto& work) {
    return [&work] {
      const DefaultFloatingPoint mode;
      work();
    };
  };
  oneapi::tbb::parallel_invoke(in_default_mode(first), in_default_mode(second));
}

/// Passes items through three stages, at most `most` at a time: cut(item) fills in the next item and returns false if
/// there is none; work(item) runs in parallel; add(item) runs on one thread at a time, in the order of cut.
template <class Item, class Cut, class Work, class Add>
void parallel_pipeline(std::size_t most, const Cut& cut, const Work& work, const Add& add) {
  using oneapi::tbb::filter_mode;
  using oneapi::tbb::make_filter;
  const auto first = make_filter<void, Item>(filter_mode::serial_in_order, [&cut](oneapi::tbb::flow_control& flow) {
    const DefaultFloatingPoint mode;
    Item item;
    if (!cut(item)) flow.stop();
    return item;
  });
  const auto second = make_filter<Item, Item>(filter_mode::parallel, [&work](const Item& item) {
    const DefaultFloatingPoint mode;
    work(item);
    return item;
  });
  const auto third = make_filter<Item, void>(filter_mode::serial_in_order, [&add](const Item& item) {
    const DefaultFloatingPoint mode;
    add(item);
  });
  oneapi::tbb::parallel_pipeline(most, first & second & third);
}

}  // namespace detp::sim
