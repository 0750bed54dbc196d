#include "result_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "detp/sim/base/memory.hpp"
#include "file_error.hpp"
#include "npy_header.hpp"
#include "table_writer.hpp"

namespace detp::sim {
namespace {

using Kind = ResultColumn::Kind;
constexpr std::size_t none = SIZE_MAX;

std::string result_suffix(const std::string& path) {
  const std::string suffix = suffix_of(path);
  for (const char* known : {".csv", ".ply", ".vtp", ".npy"})
    if (suffix == known) return suffix;
  if (suffix.empty()) return ".csv";
  throw FileError(path, "cannot be written: its name must end in .csv, .ply, .vtp or .npy, or have no suffix");
}

/// In quotes if it has what separates fields.
std::string in_csv(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char one : text) quoted += one == '"' ? "\"\"" : std::string(1, one);
  return quoted + "\"";
}

std::string in_csv(double number, const ResultColumn& column) {
  if (!std::isfinite(number)) return "";
  if (!column.names.empty()) return number < 0 ? "" : in_csv(column.names[static_cast<std::size_t>(number)]);
  return column.kind == Kind::real ? fmt::format("{}", number) : fmt::format("{:.0f}", number);
}

/// On one line, without what ends a comment or an attribute of XML.
std::string plain(std::string text) {
  for (char& one : text)
    if (static_cast<unsigned char>(one) < ' ' || one == '<' || one == '>' || one == '&' || one == '"') one = '_';
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) text[at] = '_';
  return text;
}

/// An array of a .vtp file: `components` numbers for each element.
struct Array {
  std::string name;
  bool whole = false;
  std::size_t components = 1;
  std::uint64_t elements = 0;
  std::function<double(std::uint64_t element, std::size_t component)> number;

  [[nodiscard]] std::uint64_t bytes() const { return elements * components * sizeof(double); }
};

}  // namespace

ResultFile::ResultFile(const std::string& path, std::vector<ResultColumn> columns, std::uint64_t rows,
                       const ResultPlaces& places, const char* unit, const std::stop_token& stop)
    : path_(path),
      suffix_(result_suffix(path)),
      columns_(std::move(columns)),
      rows_(rows),
      places_(places),
      check_(path_, rows, unit, stop),
      file_(path, stop) {
  for (const ResultColumn& one : columns_)
    for (std::size_t i = 0; i < one.names.size(); ++i)
      comments_.push_back(fmt::format("{} {} {}", one.name, i, plain(one.names[i])));
  if (suffix_ == ".csv") {
    std::string line;
    for (const ResultColumn& one : columns_) line += (line.empty() ? "" : ",") + one.name;
    file_.write(line + "\n");
  } else if (suffix_ == ".npy") {
    std::vector<NpyColumn> fields;
    for (const ResultColumn& one : columns_) fields.push_back({one.name, one.kind == Kind::real ? "<f8" : "<i8"});
    file_.write(npy_header(fields, rows));
  } else if (suffix_ == ".ply") {
    write_ply_header();
  } else {
    require_memory(fmt::format("{} rows of a .vtp file (.ply and .npy need no memory)", rows),
                   static_cast<double>(rows * columns_.size()) * sizeof(double));
    kept_.resize(columns_.size());
    for (std::vector<double>& one : kept_) one.reserve(rows);
  }
}

std::size_t ResultFile::column(std::string_view name) const {
  const auto found = std::ranges::find(columns_, name, &ResultColumn::name);
  return found == columns_.end() ? none : static_cast<std::size_t>(found - columns_.begin());
}

void ResultFile::write_ply_header() {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments_) text += "comment " + comment + "\n";
  const auto properties = [&] {
    for (const ResultColumn& one : columns_)
      text += fmt::format("property {} {}\n", one.kind == Kind::index ? "int" : "double", one.name);
  };
  const std::string list = "property list uchar int vertex_indices\n";
  if (rows_are_triangles()) {
    text += fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
                        places_.corners.size());
    text += fmt::format("element face {}\n{}", rows_, list);
    properties();
  } else {
    text += fmt::format("element vertex {}\n", rows_);
    properties();
    if (!places_.triangles.empty()) text += fmt::format("element face {}\n{}", places_.triangles.size(), list);
  }
  file_.write(text + "end_header\n");
  for (const glm::dvec3& corner : places_.corners)
    for (int axis = 0; axis < 3; ++axis) write_little_endian(file_, corner[axis]);
}

void ResultFile::write_number(double number, Kind kind) {
  if (suffix_ == ".ply" && kind == Kind::index) return write_little_endian(file_, static_cast<std::int32_t>(number));
  if (suffix_ != ".ply" && kind != Kind::real) return write_little_endian(file_, static_cast<std::int64_t>(number));
  write_little_endian(file_, number);
}

namespace {

void write_triangle(OutputFile& file, const std::array<std::uint32_t, 3>& triangle) {
  file.write(std::string_view("\x03", 1));
  for (const std::uint32_t corner : triangle) write_little_endian(file, static_cast<std::int32_t>(corner));
}

}  // namespace

void ResultFile::write(std::span<const double> row) {
  check_.next();
  if (suffix_ == ".vtp") {
    for (std::size_t i = 0; i < row.size(); ++i) kept_[i].push_back(row[i]);
  } else if (suffix_ == ".csv") {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i != 0) line += ',';
      line += in_csv(row[i], columns_[i]);
    }
    line += '\n';
    file_.write(line);
  } else {
    if (suffix_ == ".ply" && rows_are_triangles()) write_triangle(file_, places_.triangles[written_]);
    for (std::size_t i = 0; i < row.size(); ++i) write_number(row[i], columns_[i].kind);
  }
  ++written_;
}

void ResultFile::write_vtp() {
  const std::uint64_t points = rows_are_triangles() ? places_.corners.size() : rows_;
  const std::uint64_t polygons = places_.triangles.size();
  const std::uint64_t vertices = polygons == 0 ? rows_ : 0;
  const std::array place{column("x"), column("y"), column("z")};
  const std::array normal{column("nx"), column("ny"), column("nz")};
  std::vector<Array> of_rows;
  if (normal[0] != none)
    of_rows.push_back(
        {"normal", false, 3, rows_, [&](std::uint64_t i, std::size_t axis) { return kept_[normal[axis]][i]; }});
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (std::ranges::find(place, i) == place.end() && std::ranges::find(normal, i) == normal.end())
      of_rows.push_back({columns_[i].name, columns_[i].kind != Kind::real, 1, rows_,
                         [&, i](std::uint64_t row, std::size_t) { return kept_[i][row]; }});
  const Array positions{"positions", false, 3, points, [&](std::uint64_t i, std::size_t axis) {
                          return rows_are_triangles() ? places_.corners[i][static_cast<int>(axis)]
                                                      : kept_[place[axis]][i];
                        }};
  const std::array<Array, 2> verts{
      Array{"connectivity", true, 1, vertices, [](std::uint64_t i, std::size_t) { return static_cast<double>(i); }},
      Array{"offsets", true, 1, vertices, [](std::uint64_t i, std::size_t) { return static_cast<double>(i + 1); }}};
  const std::array<Array, 2> polys{
      Array{"connectivity", true, 1, 3 * polygons,
            [&](std::uint64_t i, std::size_t) { return static_cast<double>(places_.triangles[i / 3][i % 3]); }},
      Array{"offsets", true, 1, polygons, [](std::uint64_t i, std::size_t) { return 3 * static_cast<double>(i + 1); }}};
  std::vector<const Array*> all;
  std::uint64_t offset = 0;
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n";
  for (const std::string& comment : comments_) text += fmt::format("<!-- {} -->\n", comment);
  text += fmt::format(
      "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n",
      points, vertices, polygons);
  const auto declare = [&](const Array& one) {
    text += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        one.whole ? "Int64" : "Float64", plain(one.name), one.components, offset);
    offset += sizeof(std::uint64_t) + one.bytes();
    all.push_back(&one);
  };
  const std::string_view data = rows_are_triangles() ? "CellData" : "PointData";
  text += fmt::format("<{} Scalars=\"irradiance\"{}>\n", data, normal[0] == none ? "" : " Normals=\"normal\"");
  for (const Array& one : of_rows) declare(one);
  text += fmt::format("</{}>\n<Points>\n", data);
  declare(positions);
  text += "</Points>\n<Verts>\n";
  for (const Array& one : verts) declare(one);
  text += "</Verts>\n<Polys>\n";
  for (const Array& one : polys) declare(one);
  file_.write(text + "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
  for (const Array* one : all) {
    write_little_endian(file_, one->bytes());
    for (std::uint64_t i = 0; i < one->elements; ++i)
      for (std::size_t component = 0; component < one->components; ++component)
        write_number(one->number(i, component), one->whole ? Kind::index : Kind::real);
  }
  file_.write("\n</AppendedData>\n</VTKFile>\n");
}

void ResultFile::commit() {
  if (suffix_ == ".vtp") write_vtp();
  if (suffix_ == ".ply" && !rows_are_triangles())
    for (const auto& triangle : places_.triangles) write_triangle(file_, triangle);
  file_.commit();
}

}  // namespace detp::sim
