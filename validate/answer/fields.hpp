#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/base/json.hpp"

/// The fields of an answer, listed once. JSON, the columns of tables and the page that explains them come from the list.
namespace detp::validate {

/// The value of a field that an answer does not have: neither JSON nor a table's row has it.
[[nodiscard]] inline Json left_out() { return Json::value_t::discarded; }

/// A column of tables that a field fills: its name, and the place of its value in the field's JSON ("/total", "/0"; empty: the whole).
struct Column {
  std::string name;
  std::string place = {};
};

/// One field of an answer. Tables have it under its name, unless it says otherwise.
template <class Answer>
struct Field {
  /// The value of an answer: a member, or a function.
  template <class Value>
  Field(std::string its_name, std::string its_unit, std::string its_meaning, Value its_value)
      : name(std::move(its_name)),
        unit(std::move(its_unit)),
        meaning(std::move(its_meaning)),
        value([its_value](const Answer& answer) { return json_value(std::invoke(its_value, answer)); }),
        columns{{name}} {}

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
  /// Counts: a column for each term, and one for the sum of the tests, each after the prefix ("predicted_").
  [[nodiscard]] Field as_counts(const std::string& prefix) const {
    std::vector<Column> terms;
    for_each_term(Counts<double>{}, [&](std::string_view term, double) {
      terms.push_back({prefix + std::string(term), "/" + std::string(term)});
    });
    Field field = in(std::move(terms));
    field.tests = prefix + "tests";
    return field;
  }

  std::string name;
  std::string unit;  ///< "s", "bytes"; empty for words, shares and numbers of things
  std::string meaning;
  std::function<Json(const Answer&)> value;
  std::vector<Column> columns;
  std::string tests = {};  ///< of counts: the column of their sum
  bool in_json = true;
};

template <class Answer>
using Fields = std::vector<Field<Answer>>;

template <class Answer>
[[nodiscard]] Fields<Answer> operator+(Fields<Answer> left, const Fields<Answer>& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// Fields of a part of the answer.
template <class Answer, class Part, class PartOf>
[[nodiscard]] Fields<Answer> fields_of_part(const Fields<Part>& fields, PartOf part) {
  Fields<Answer> all;
  for (const Field<Part>& one : fields) {
    Field<Answer> field(one.name, one.unit, one.meaning,
                        [value = one.value, part](const Answer& answer) { return value(std::invoke(part, answer)); });
    field.columns = one.columns;
    field.tests = one.tests;
    field.in_json = one.in_json;
    all.push_back(std::move(field));
  }
  return all;
}

/// Fields of a part that the answer may not have: all are then left out.
template <class Answer, class Part>
[[nodiscard]] Fields<Answer> fields_of_optional(const Fields<Part>& fields, std::optional<Part> Answer::*part) {
  Fields<Answer> all = fields_of_part<Answer>(fields, [part](const Answer& answer) { return *(answer.*part); });
  for (Field<Answer>& field : all)
    field.value = [of = field.value, part](const Answer& answer) { return answer.*part ? of(answer) : left_out(); };
  return all;
}

template <class Answer>
[[nodiscard]] Json json_of(const Fields<Answer>& fields, const Answer& answer) {
  Json json = Json::object();
  for (const Field<Answer>& field : fields)
    if (field.in_json)
      if (Json value = field.value(answer); !value.is_discarded()) json[field.name] = std::move(value);
  return json;
}

template <class Answer>
[[nodiscard]] Columns columns_of(const Fields<Answer>& fields) {
  Columns columns;
  for (const Field<Answer>& field : fields) {
    for (const Column& column : field.columns) columns.push_back(column.name);
    if (!field.tests.empty()) columns.push_back(field.tests);
  }
  return columns;
}

/// A row of a table, without what the answer has not.
template <class Answer>
[[nodiscard]] Json cells_of(const Fields<Answer>& fields, const Answer& answer) {
  Json cells = Json::object();
  for (const Field<Answer>& field : fields) {
    if (field.columns.empty()) continue;
    const Json value = field.value(answer);
    if (value.is_discarded()) continue;
    for (const Column& column : field.columns)
      if (const Json::json_pointer place(column.place); value.contains(place)) cells[column.name] = value.at(place);
    if (!field.tests.empty() && value.is_object())
      cells[field.tests] =
          value.at("cull_tests").template get<double>() + value.at("disc_tests").template get<double>();
  }
  return cells;
}

/// What a list of fields says of one.
struct FieldText {
  std::string name;
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

[[nodiscard]] inline std::vector<FieldText> operator+(std::vector<FieldText> left,
                                                      const std::vector<FieldText>& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

}  // namespace detp::validate
