#pragma once

#include <string>
#include <vector>

#include "accuracy_answer.hpp"
#include "detp/validate/base/fields.hpp"

/// The answer of `detp accuracy` as JSON, as a table and in sentences.
namespace detp::validate {

/// What was asked, with what was not set resolved.
[[nodiscard]] Json inputs_json(const AccuracyAnswer& answer);
[[nodiscard]] Json to_json(const AccuracyAnswer& answer);

/// The table has a row for the answer, each rival, each point of the curves, each run again, and each point of other axes.
[[nodiscard]] Columns accuracy_columns();
[[nodiscard]] std::vector<Json> accuracy_rows(const AccuracyAnswer& answer);

/// All fields of the JSON and of the table; those of a part have its name before theirs ("reference.kind").
[[nodiscard]] std::vector<FieldText> describe_accuracy();

/// "4.2 %".
[[nodiscard]] std::string percent(double share);

/// "9 % (8 to 10)", "at most 2 %", "none".
[[nodiscard]] std::string bias_words(const AccuracyPoint& point);

/// "d = 2.1 %", "k = 50"; empty if the estimator has no setting.
[[nodiscard]] std::string setting_words(const AccuracyAnswer& answer, const AccuracyPoint& point);

/// "340 000 photon paths with discs of radius 0.021 (2.1 % of the scene), estimator disc".
[[nodiscard]] std::string way_words(const AccuracyAnswer& answer, const AccuracyPoint& point);

/// "detp run @cornell --rays 3.4e5 --estimator disc --disc-radius 0.021".
[[nodiscard]] std::string command_of(const AccuracyAnswer& answer, const AccuracyPoint& point);

/// The answer in sentences.
[[nodiscard]] std::string answer_words(const AccuracyAnswer& answer);

/// "disc is best; nearest takes 2.4 times as long (bias at most 2 %)".
[[nodiscard]] std::string rivals_words(const AccuracyAnswer& answer);

/// "5 runs with seeds 3 to 7: noise 5 % (4.8 % to 5.2 %), inside the interval in 5; …". There must be some.
[[nodiscard]] std::string reruns_words(const AccuracyAnswer& answer);

/// "against 64 backward paths of each of 1000 samples (error 2 %)."
[[nodiscard]] std::string judge_words(const AccuracyAnswer& answer);

}  // namespace detp::validate
