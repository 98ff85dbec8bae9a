// SPDX-License-Identifier: Apache-2.0
/// Untrusted JSON: parsed with limits, read through a cursor whose errors name the file and the place.
///
/// Limits are enforced before anything is built: size of the text, nesting depth (a linear scan that knows strings),
/// and NaN / Infinity tokens, which JSON does not have although some writers emit them. A byte-order mark is passed
/// over. Errors are std::runtime_error with one line "path: byte N: what was found, expected what".
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace bodyloom {

struct JsonLimits {
  size_t max_bytes = size_t{256} << 20;
  int max_depth = 64;
  /// NaN, Infinity and -Infinity, which Python's json module writes, become null; otherwise they are an error.
  bool nan_is_null = false;
};

/// Parses `text`; `where` names the file in messages.
nlohmann::json ParseJson(const std::string& text, const std::string& where, const JsonLimits& limits = {});
/// The same for a text that may be JSON Lines: several objects or arrays, separated by blanks or line breaks, become
/// the array of them. A last one that is cut off is left out and `warnings`, when requested, gets a line.
nlohmann::json ParseJsonLines(const std::string& text, const std::string& where, const JsonLimits& limits = {},
                              std::vector<std::string>* warnings = nullptr);
nlohmann::json ReadJsonFile(const std::string& path, const JsonLimits& limits = {});

/// A JSON value with its location ("calib.json: cameras[2].K"). Refers to a document that must outlive it.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, std::string place) : value_(&value), place_(std::move(place)) {}

  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] bool is_object() const;
  [[nodiscard]] bool is_array() const;
  [[nodiscard]] bool is_number() const;
  [[nodiscard]] bool is_string() const;
  [[nodiscard]] bool is_null() const;
  /// Number of entries of an array or object; 0 for anything else.
  [[nodiscard]] size_t size() const;
  /// Returns true if this is an object with that key.
  [[nodiscard]] bool Has(const std::string& key) const;
  [[nodiscard]] std::vector<std::string> Keys() const;

  // The functions below throw std::runtime_error naming the place when the value is not as requested.
  [[nodiscard]] JsonNode At(const std::string& key) const;
  [[nodiscard]] JsonNode At(size_t index) const;
  [[nodiscard]] double Number() const;    ///< finite
  [[nodiscard]] int64_t Integer() const;  ///< exactly integral
  [[nodiscard]] int Int() const;          ///< an Integer that an int holds
  [[nodiscard]] bool Flag() const;        ///< true or false
  [[nodiscard]] std::string Text() const;
  /// All numbers of an array, nested arrays flattened in order; `expected_count` < 0 accepts any number of them.
  [[nodiscard]] std::vector<double> Numbers(int expected_count = -1) const;
  /// Number() and Numbers() that take null for NaN, as JavaScript and JsonLimits::nan_is_null write it.
  [[nodiscard]] double NumberOrNan() const;
  [[nodiscard]] std::vector<double> NumbersOrNan(int expected_count = -1) const;
  /// Throws "place: found <kind>, expected <expected>".
  [[noreturn]] void Fail(const std::string& expected) const;

 private:
  void AppendNumbers(const nlohmann::json& value, bool null_is_nan, std::vector<double>* numbers) const;
  [[nodiscard]] std::vector<double> AllNumbers(int expected_count, bool null_is_nan) const;

  const nlohmann::json* value_;
  std::string place_;
};

}  // namespace bodyloom
