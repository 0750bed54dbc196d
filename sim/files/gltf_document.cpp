#include "gltf_document.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <map>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/memory.hpp"
#include "file_error.hpp"
#include "input_file.hpp"
#include "mtl_file.hpp"

namespace detp::sim {
namespace {

using Json = nlohmann::json;

std::string without_percents(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto is_hex = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
    if (uri[i] == '%' && i + 2 < uri.size() && is_hex(uri[i + 1]) && is_hex(uri[i + 2])) {
      text += static_cast<char>(std::stoi(std::string(uri.substr(i + 1, 2)), nullptr, 16));
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text.substr(0, text.find_last_not_of('=') + 1)) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFFU);
  }
  return bytes;
}

std::size_t most_bytes() { return static_cast<std::size_t>(memory_budget()); }

/// JSON, and the binary part of a .glb.
struct GltfText {
  Json json;
  std::optional<std::string> binary = {};
};

Json parsed(const std::string& path, std::string_view text) {
  const auto fail = [&](const std::string& why) { throw FileError(path, "is no glTF: " + why); };
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    fail(fmt::format("its JSON has an error near byte {}", std::string_view(error.what()).find("byte")));
  }
  if (!json.is_object() || !json.contains("asset")) fail("its JSON has no member asset");
  const Json& version = json["asset"].is_object() ? json["asset"].value("version", Json()) : Json();
  if (!version.is_string() || !version.get<std::string>().starts_with("2."))
    fail(fmt::format("version 2.x is read (got {})", detp::quoted(version.dump())));
  return json;
}

GltfText read_text(const std::string& path, std::stop_token stop) {
  std::string content = read_file(path, most_bytes(), std::move(stop));
  if (!content.starts_with("glTF")) return {parsed(path, content)};
  constexpr bool swapped = std::endian::native != std::endian::little;
  GltfText text;
  bool has_json = false;
  for (std::size_t at = 12; at < content.size();) {
    if (content.size() - at < 8) throw FileError(path, "ends early, within the head of a chunk");
    const auto length = static_cast<std::size_t>(number_at(content.data() + at, NumberType::uint32, swapped));
    const std::string_view kind = std::string_view(content).substr(at + 4, 4);
    at += 8;
    if (length > content.size() - at) throw FileError(path, "ends early, within a chunk");
    if (kind == "JSON" && !has_json) {
      text.json = parsed(path, std::string_view(content).substr(at, length));
      has_json = true;
    } else if (kind == std::string_view("BIN\0", 4) && !text.binary) {
      text.binary = content.substr(at, length);
    }
    at += length;
  }
  if (!has_json) throw FileError(path, "has no chunk of JSON");
  return text;
}

/// Whether a buffer is in the JSON itself.
bool is_data(std::string_view uri) { return uri.starts_with("data:"); }

}  // namespace

GltfDocument::GltfDocument(const std::string& path, const std::stop_token& stop, bool with_buffers) : path_(path) {
  GltfText text = read_text(path, stop);
  json_ = std::move(text.json);
  refuse_extensions();
  if (with_buffers) read_buffers(std::move(text.binary), stop);
}

void GltfDocument::fail(const std::string& what) const { throw FileError(path_, what); }

const GltfDocument::Json& GltfDocument::list(const char* name) const {
  static const Json none = Json::array();
  const auto found = json_.find(name);
  if (found == json_.end()) return none;
  if (!found->is_array()) fail(fmt::format("{} is no list", name));
  return *found;
}

const GltfDocument::Json* GltfDocument::referred(const Json& from, const char* key, const char* name) const {
  const auto index = whole(from, key);
  if (!index) return nullptr;
  const Json& all = list(name);
  if (*index >= all.size() || !all[*index].is_object())
    fail(fmt::format("{} {} is not there: there are {}", name, *index, all.size()));
  return &all[*index];
}

std::optional<std::size_t> GltfDocument::whole(const Json& from, const char* key) const {
  const auto found = from.find(key);
  if (found == from.end()) return std::nullopt;
  if (!found->is_number_unsigned()) fail(fmt::format("{} is no whole number", key));
  return found->get<std::size_t>();
}

void GltfDocument::refuse_extensions() const {
  constexpr std::array changing{"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing",
                                "KHR_meshopt_compression"};
  for (const Json& one : list("extensionsRequired"))
    if (one.is_string() && std::ranges::find(changing, one.get<std::string>()) != changing.end())
      fail(fmt::format("needs {}, which is not read: export it without", one.get<std::string>()));
}

void GltfDocument::read_buffers(std::optional<std::string> binary, const std::stop_token& stop) {
  for (const Json& one : list("buffers")) {
    const auto length = one.is_object() ? whole(one, "byteLength") : std::nullopt;
    if (!length) fail("a buffer has no byteLength");
    std::string& bytes = buffers_.emplace_back();
    if (const auto uri = one.find("uri"); uri != one.end() && uri->is_string())
      bytes = bytes_of(uri->get<std::string>(), stop);
    else if (binary)
      bytes = std::move(*std::exchange(binary, std::nullopt));
    if (bytes.size() < *length)
      fail(fmt::format("buffer {} has {} bytes; {} are needed", buffers_.size() - 1, bytes.size(), *length));
  }
}

std::string GltfDocument::bytes_of(const std::string& uri, const std::stop_token& stop) const {
  if (!is_data(uri)) return read_file(beside(path_, without_percents(uri)), most_bytes(), stop);
  const std::size_t comma = uri.find(',');
  const auto bytes = comma != std::string::npos && uri.substr(0, comma).ends_with(";base64")
                         ? from_base64(std::string_view(uri).substr(comma + 1))
                         : std::nullopt;
  if (!bytes) fail("a buffer in the file itself is not in base64");
  return *bytes;
}

std::vector<std::size_t> GltfDocument::indices_in(const Json& from, const char* key) const {
  std::vector<std::size_t> all;
  const auto found = from.find(key);
  if (found == from.end()) return all;
  for (const Json& one : *found) {
    if (!one.is_number_unsigned()) fail(fmt::format("{} has no whole numbers alone", key));
    all.push_back(one.get<std::size_t>());
  }
  return all;
}

std::vector<double> GltfDocument::numbers_in(const Json& from, const char* key, std::size_t count) const {
  std::vector<double> all;
  const auto found = from.find(key);
  if (found == from.end()) return all;
  for (const Json& one : *found) {
    if (!one.is_number()) fail(fmt::format("{} has no numbers alone", key));
    all.push_back(one.get<double>());
  }
  if (all.size() != count) fail(fmt::format("{} needs {} numbers (got {})", key, count, all.size()));
  return all;
}

std::optional<GltfRows> GltfDocument::rows(const Json& from, const char* key, std::size_t components) const {
  const Json* accessor = referred(from, key, "accessors");
  if (accessor == nullptr) return std::nullopt;
  if (accessor->contains("sparse")) fail("has sparse accessors, which are not read");
  const Json* view = referred(*accessor, "bufferView", "bufferViews");
  if (view == nullptr) fail(fmt::format("the accessor of {} has no bufferView", key));
  const auto buffer = whole(*view, "buffer");
  if (!buffer || *buffer >= buffers_.size()) fail("a bufferView has no buffer that is there");
  static const std::map<std::size_t, std::pair<NumberType, double>> types{{5120, {NumberType::int8, 127}},
                                                                          {5121, {NumberType::uint8, 255}},
                                                                          {5122, {NumberType::int16, 32767}},
                                                                          {5123, {NumberType::uint16, 65535}},
                                                                          {5125, {NumberType::uint32, 4294967295.0}},
                                                                          {5126, {NumberType::float32, 1}}};
  const auto type = types.find(whole(*accessor, "componentType").value_or(0));
  static const std::map<std::string, std::size_t> shapes{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
  const auto shape =
      shapes.find(accessor->value("type", Json()).is_string() ? (*accessor)["type"].get<std::string>() : "");
  if (type == types.end() || shape == shapes.end() || shape->second != components)
    fail(fmt::format("the accessor of {} has another type than {} numbers", key, components));
  const NumberType number = type->second.first;
  const bool unsigned_whole =
      number == NumberType::uint8 || number == NumberType::uint16 || number == NumberType::uint32;
  if (components == 1 && !unsigned_whole) fail("indices are no whole numbers from 0 on");
  GltfRows found{.count = whole(*accessor, "count").value_or(0), .components = components, .type = type->second.first};
  if (components > 1 && accessor->value("normalized", Json()) == true) found.divisor = type->second.second;
  const std::size_t size = components * size_of(found.type);
  found.stride = whole(*view, "byteStride").value_or(size);
  const std::string& bytes = buffers_[*buffer];
  const std::size_t begin = whole(*view, "byteOffset").value_or(0);
  const std::size_t length = whole(*view, "byteLength").value_or(0);
  const std::size_t offset = whole(*accessor, "byteOffset").value_or(0);
  if (begin > bytes.size() || length > bytes.size() - begin) fail("a bufferView ends beyond its buffer");
  const bool fits = found.count == 0 || (offset <= length && size <= length - offset && found.stride >= size &&
                                         (found.count - 1) <= (length - offset - size) / found.stride);
  if (!fits) fail(fmt::format("the accessor of {} ends beyond its bufferView", key));
  found.first = bytes.data() + begin + offset;
  return found;
}

std::vector<std::string> GltfDocument::buffer_files() const {
  std::vector<std::string> paths;
  for (const Json& one : list("buffers"))
    if (const auto uri = one.find("uri"); one.is_object() && uri != one.end() && uri->is_string())
      if (const auto name = uri->get<std::string>(); !is_data(name))
        paths.push_back(beside(path_, without_percents(name)));
  return paths;
}

}  // namespace detp::sim
