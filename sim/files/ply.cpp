#include "ply.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "detp/sim/base/kept_memory.hpp"
#include "file_error.hpp"
#include "ply_source.hpp"

namespace detp::sim {
namespace {

template <class Source>
class BodyReader {
 public:
  BodyReader(const std::string& path, Source source) : path_(path), source_(std::move(source)), memory_(path) {}

  void read(const PlyElement& element, const PlyRequest* request) {
    check_size(element);
    if (element.properties.empty()) return;
    PlyValues values(request == nullptr ? 0 : request->properties.size());
    std::vector<std::vector<double>*> places(element.properties.size());  // null: skipped
    for (std::size_t i = 0; i < values.size(); ++i) places[request->properties[i]] = &values[i];
    for (row_ = 1; row_ <= element.rows; ++row_) {
      for (std::vector<double>& entries : values) entries.clear();
      for (std::size_t i = 0; i < places.size(); ++i) read(element, element.properties[i], places[i]);
      if (request != nullptr) request->on_row(row_ - 1, values);
    }
  }

  void check_end() {
    if (!source_.at_end()) throw FileError(path_, "has more data than its header declares" + source_.where());
  }

 private:
  [[noreturn]] void fail(const PlyElement& element, const std::string& what) const {
    throw FileError(path_, shortened(element.name) + " " + std::to_string(row_) + " of " +
                               std::to_string(element.rows) + source_.where() + ": " + what);
  }

  /// Rejects an element with more data than the rest of the file, if the file's size is known.
  void check_size(const PlyElement& element) const {
    std::uint64_t least = 0;
    for (const PlyProperty& property : element.properties)
      least += Source::least_size(property.count_type.value_or(property.type));
    const auto rest = source_.rest();
    if (rest && least > 0 && element.rows > *rest / least)
      throw FileError(path_, "ends early: the header says " + std::to_string(element.rows) + " rows of element " +
                                 shortened(element.name) + ", the file has room for " + std::to_string(*rest / least));
  }

  void read(const PlyElement& element, const PlyProperty& property, std::vector<double>* to) {
    double entries = 1;
    if (property.count_type) entries = length(element, property, number(element, property, *property.count_type));
    for (; entries > 0; --entries) {
      const double value = number(element, property, property.type);
      if (to != nullptr) memory_.push(*to, value);
    }
  }

  double number(const PlyElement& element, const PlyProperty& property, NumberType type) {
    const auto value = source_.next(type);
    if (!value) fail(element, source_.missing_number_reason(detp::quoted(property.name)));
    return *value;
  }

  double length(const PlyElement& element, const PlyProperty& property, double count) const {
    if (!(count >= 0) || std::floor(count) != count)
      fail(element, "its " + detp::quoted(property.name) + " has no valid length");
    const auto rest = source_.rest();
    if (rest && count * static_cast<double>(Source::least_size(property.type)) > static_cast<double>(*rest))
      fail(element, "the file ends early, within " + detp::quoted(property.name));
    return count;
  }

  const std::string& path_;
  Source source_;
  KeptMemory memory_;
  std::uint64_t row_ = 1;
};

template <class Source>
void read_body(const std::string& path, const PlyHeader& header, const std::vector<PlyRequest>& requests,
               Source source) {
  BodyReader<Source> body(path, std::move(source));
  for (const PlyElement& element : header.elements) {
    const auto request = std::find_if(requests.begin(), requests.end(),
                                      [&](const PlyRequest& each) { return each.element == element.name; });
    body.read(element, request == requests.end() ? nullptr : &*request);
  }
  body.check_end();
}

}  // namespace

PlyFile::PlyFile(const std::string& path, std::stop_token stop)
    : file_(path, std::move(stop)), header_(read_ply_header(file_)) {}

const PlyElement* PlyFile::element(std::string_view name) const {
  const auto found = std::find_if(header_.elements.begin(), header_.elements.end(),
                                  [name](const PlyElement& element) { return element.name == name; });
  return found == header_.elements.end() ? nullptr : &*found;
}

void PlyFile::read(const std::vector<PlyRequest>& requests) {
  if (header_.format == PlyFormat::ascii)
    return read_body(file_.path(), header_, requests, PlyText(file_, header_.lines));
  const bool little = header_.format == PlyFormat::little_endian;
  read_body(file_.path(), header_, requests, PlyBytes(file_, little ? std::endian::little : std::endian::big));
}

}  // namespace detp::sim
