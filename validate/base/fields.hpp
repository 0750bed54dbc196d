#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "json.hpp"

/// The fields of an answer, listed once. JSON, the columns of tables and the page that explains them come from the list.
namespace detp::validate {

/// The value of a field that an answer does not have: neither JSON nor a table's row has it.
[[nodiscard]] inline Json left_out() { return Json::value_t::discarded; }

/// The value; an empty optional is left out.
template <class T>
[[nodiscard]] Json if_any(const T& value) {
  return json_value(value);
}
template <class T>
[[nodiscard]] Json if_any(const std::optional<T>& value) {
  return value ? json_value(*value) : left_out();
}

/// The value of a part that an answer may lack (an optional or a pointer); left out without the part, or without a value.
template <class Part, class Value>
[[nodiscard]] auto of_part(Part part, Value value) {
  return [part, value](const auto& answer) -> Json {
    const auto& one = std::invoke(part, answer);
    return one ? if_any(std::invoke(value, *one)) : left_out();
  };
}

/// A value that only some answers have.
template <class Has, class Value>
[[nodiscard]] auto only_if(Has has, Value value) {
  return [has, value](const auto& answer) {
    return std::invoke(has, answer) ? json_value(std::invoke(value, answer)) : left_out();
  };
}

/// A column of tables that a field fills: its name, and the place of its value in the field's JSON ("/total", "/0"; empty: the whole).
struct Column {
  std::string name;
  std::string place = {};
};

/// Who has a field.
enum class FieldPlace { json_and_tables, json_alone, tables_alone };

/// One field of an answer. Tables have it under its name, unless it says otherwise.
template <class Answer>
struct Field {
  /// The value of an answer: a member, or a function.
  template <class Value>
  Field(std::string its_name, std::string its_unit, std::string its_meaning, Value its_value, FieldPlace place = {})
      : name(std::move(its_name)),
        unit(std::move(its_unit)),
        meaning(std::move(its_meaning)),
        value([its_value](const Answer& answer) { return json_value(std::invoke(its_value, answer)); }),
        in_json(place != FieldPlace::tables_alone) {
    if (place != FieldPlace::json_alone) columns = {{name}};
  }

  /// The same field under these columns; none: it stands in JSON alone.
  [[nodiscard]] Field in(std::vector<Column> other) const {
    Field field = *this;
    field.columns = std::move(other);
    return field;
  }
  [[nodiscard]] Field in_json_alone() const { return in({}); }
  /// In tables alone.
  [[nodiscard]] Field in_tables_alone() const {
    Field field = *this;
    field.in_json = false;
    return field;
  }
  /// Left out, instead of null, where the answer has no value.
  [[nodiscard]] Field where_known() const {
    Field field = *this;
    field.value = [of = value](const Answer& answer) {
      Json one = of(answer);
      return one.is_null() ? left_out() : one;
    };
    return field;
  }
  /// An interval [low, high], as "noise_low" and "noise_high".
  [[nodiscard]] Field as_interval(const std::string& of) const {
    return in({{of + "_low", "/0"}, {of + "_high", "/1"}});
  }
  /// Under these columns, which `cells_of` fills from the value.
  [[nodiscard]] Field by(const Columns& names, std::function<Json(const Answer&, const Json& value)> cells_of) const {
    Field field = in({});
    for (const std::string& one : names) field.columns.push_back({one});
    field.cells = std::move(cells_of);
    return field;
  }

  /// Counts: a column for each term, and one for the sum of the tests, each after the prefix ("predicted_").
  [[nodiscard]] Field as_counts(const std::string& prefix) const {
    Columns names;
    for_each_term(Counts<double>{},
                  [&](std::string_view term, double) { names.push_back(prefix + std::string(term)); });
    names.push_back(prefix + "tests");
    return by(names, [prefix](const Answer&, const Json& counts) {
      Json terms = Json::object();
      for (const auto& [term, count] : counts.items()) terms[prefix + term] = count;
      terms[prefix + "tests"] =
          counts["cull_tests"].template get<double>() + counts["disc_tests"].template get<double>();
      return terms;
    });
  }

  std::string name;
  std::string unit;  ///< "s", "bytes"; empty for words, shares and numbers of things
  std::string meaning;
  std::function<Json(const Answer&)> value;
  std::vector<Column> columns = {};
  std::function<Json(const Answer&, const Json& value)> cells =
      {};  ///< of the columns, by name; if it is set, columns have no places
  bool in_json = true;
};

template <class Answer>
using Fields = std::vector<Field<Answer>>;

/// One list after the other.
template <class T>
[[nodiscard]] std::vector<T> operator+(std::vector<T> left, const std::vector<T>& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// A value, then a member of it or a function of that, and so on; left out behind a pointer or an optional that is empty.
template <class Value, class... Members>
[[nodiscard]] Json value_at(const Value& value, const Members&... members) {
  if constexpr (sizeof...(members) == 0)
    return json_value(value);
  else if constexpr (requires { *value; })
    return value ? value_at(*value, members...) : left_out();
  else
    return [&](const auto& first, const auto&... rest) {
      return value_at(std::invoke(first, value), rest...);
    }(members...);
}

/// The value of a field that is a part of a part: at(&Plan::answer, &Point::seconds).
template <class... Members>
[[nodiscard]] auto at(Members... members) {
  return [members...](const auto& answer) { return value_at(answer, members...); };
}

/// Fields of a part of the answer; left out where the part is an optional or a pointer that is empty.
template <class Answer, class Part, class PartOf>
[[nodiscard]] Fields<Answer> fields_of_part(const Fields<Part>& fields, PartOf part) {
  Fields<Answer> all;
  for (const Field<Part>& one : fields) {
    Field<Answer> field(one.name, one.unit, one.meaning, [value = one.value, part](const Answer& answer) -> Json {
      const auto& found = std::invoke(part, answer);
      if constexpr (std::is_convertible_v<decltype(found), const Part&>)
        return value(found);
      else
        return found ? value(*found) : left_out();
    });
    field.columns = one.columns;
    if (one.cells)
      field.cells = [cells = one.cells, part](const Answer& answer, const Json& value) {
        const auto& found = std::invoke(part, answer);
        if constexpr (std::is_convertible_v<decltype(found), const Part&>)
          return cells(found, value);
        else
          return cells(*found, value);
      };
    field.in_json = one.in_json;
    all.push_back(std::move(field));
  }
  return all;
}

/// The fields with these names.
template <class Answer>
[[nodiscard]] Fields<Answer> only(const Fields<Answer>& fields, const std::vector<std::string_view>& names) {
  Fields<Answer> some;
  for (const Field<Answer>& field : fields)
    if (std::find(names.begin(), names.end(), field.name) != names.end()) some.push_back(field);
  return some;
}

template <class Answer>
[[nodiscard]] Json json_of(const Fields<Answer>& fields, const Answer& answer) {
  Json json = Json::object();
  for (const Field<Answer>& field : fields)
    if (field.in_json)
      if (Json value = field.value(answer); !value.is_discarded()) json[field.name] = std::move(value);
  return json;
}

/// An array with an object for each row.
template <class Row>
[[nodiscard]] Json rows_json(const Fields<Row>& fields, const std::vector<Row>& rows) {
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(json_of(fields, row));
  return json;
}

template <class Answer>
[[nodiscard]] Columns columns_of(const Fields<Answer>& fields) {
  Columns columns;
  for (const Field<Answer>& field : fields)
    for (const Column& column : field.columns) columns.push_back(column.name);
  return columns;
}

/// A list of texts as one cell, separated by "; "; any other value as it is.
[[nodiscard]] inline Json one_cell(const Json& value) {
  if (!value.is_array()) return value;
  std::string texts;
  for (const Json& one : value) texts += (texts.empty() ? "" : "; ") + one.get<std::string>();
  return texts;
}

/// A row of a table, without what the answer has not. `json` of the same answer, if it is given: its values are taken, not found again.
template <class Answer>
[[nodiscard]] Json cells_of(const Fields<Answer>& fields, const Answer& answer, const Json& json = Json::object()) {
  Json cells = Json::object();
  for (const Field<Answer>& field : fields) {
    if (field.columns.empty()) continue;
    const Json value = field.in_json && json.contains(field.name) ? json[field.name] : field.value(answer);
    if (value.is_discarded()) continue;
    if (field.cells) {
      cells.update(field.cells(answer, value));
      continue;
    }
    for (const Column& column : field.columns)
      if (const Json::json_pointer place(column.place); value.contains(place))
        cells[column.name] = one_cell(value.at(place));
  }
  return cells;
}

/// What a list of fields says of one.
struct FieldText {
  std::string name;  ///< empty: of tables alone
  std::string unit;
  std::string meaning;
  Columns columns;
};

template <class Answer>
[[nodiscard]] std::vector<FieldText> describe_fields(const Fields<Answer>& fields) {
  std::vector<FieldText> texts;
  for (const Field<Answer>& field : fields)
    texts.push_back({field.in_json ? field.name : "", field.unit, field.meaning, columns_of(Fields<Answer>{field})});
  return texts;
}

}  // namespace detp::validate
