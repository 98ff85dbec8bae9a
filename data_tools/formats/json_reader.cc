// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/json_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"

namespace bodyloom {

using nlohmann::json;

namespace {

[[noreturn]] void FailAt(const std::string& where, size_t byte, const std::string& message) {
  throw std::runtime_error(where + ": byte " + std::to_string(byte) + ": " + message);
}

/// Walks the text once, string-aware. Up to the first syntax error the count equals the parser's own depth, so a parser
/// that runs afterwards never builds deeper than the limit.
void CheckDepthAndTokens(const std::string& text, const std::string& where, int max_depth) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') {
        ++i;
      } else if (c == '"') {
        in_string = false;
      }
      continue;
    }
    if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > max_depth) {
        FailAt(where, i, "nested deeper than " + std::to_string(max_depth) + " levels");
      }
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == 'N' || c == 'I') {
      FailAt(where, i, "found NaN or Infinity, which JSON does not have; expected a finite number or null");
    }
  }
}

/// nlohmann's messages start with "[json.exception...] parse error at line 1, column 5: "; the last part is the useful
/// one. They quote the input, which may contain arbitrary characters.
std::string Reason(const json::exception& error) {
  const std::string text = error.what();
  const size_t marker = text.find("syntax error");
  std::string reason = marker == std::string::npos ? text : text.substr(marker);
  std::replace_if(
      reason.begin(), reason.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return reason;
}

const char* KindName(const json& value) { return value.type_name(); }

}  // namespace

json ParseJson(const std::string& text, const std::string& where, const JsonLimits& limits) {
  if (text.size() > limits.max_bytes) {
    throw std::runtime_error(where + ": " + std::to_string(text.size()) + " bytes of JSON, at most " +
                             std::to_string(limits.max_bytes) + " are read");
  }
  CheckDepthAndTokens(text, where, limits.max_depth);
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    FailAt(where, error.byte, "not valid JSON: " + Reason(error));
  } catch (const json::exception& error) {
    throw std::runtime_error(where + ": not usable JSON: " + Reason(error));
  }
}

json ReadJsonFile(const std::string& path, const JsonLimits& limits) {
  return ParseJson(ReadFileBytes(path, limits.max_bytes), path, limits);
}

bool JsonNode::is_object() const { return value_->is_object(); }
bool JsonNode::is_array() const { return value_->is_array(); }
bool JsonNode::is_number() const { return value_->is_number(); }
bool JsonNode::is_string() const { return value_->is_string(); }
bool JsonNode::is_null() const { return value_->is_null(); }
size_t JsonNode::size() const { return value_->is_structured() ? value_->size() : 0; }
bool JsonNode::Has(const std::string& key) const { return value_->is_object() && value_->contains(key); }

std::vector<std::string> JsonNode::Keys() const {
  std::vector<std::string> keys;
  if (!value_->is_object()) return keys;
  for (const auto& [key, unused] : value_->items()) keys.push_back(key);
  return keys;
}

JsonNode JsonNode::At(const std::string& key) const {
  if (!value_->is_object()) Fail("an object with '" + key + "'");
  const auto found = value_->find(key);
  if (found == value_->end()) {
    throw std::runtime_error(place_ + ": no '" + key + "'; present: " + PrintableList(Keys()));
  }
  return {*found, place_ + (place_.find(": ") == std::string::npos ? ": " : ".") + PrintableText(key)};
}

JsonNode JsonNode::At(size_t index) const {
  if (!value_->is_array()) Fail("an array");
  if (index >= value_->size()) {
    throw std::runtime_error(place_ + ": " + std::to_string(value_->size()) + " entries, expected more than " +
                             std::to_string(index));
  }
  return {(*value_)[index],
          place_ + (place_.find(": ") == std::string::npos ? ": " : "") + "[" + std::to_string(index) + "]"};
}

double JsonNode::Number() const {
  if (!value_->is_number()) Fail("a number");
  const double number = value_->get<double>();
  if (!std::isfinite(number)) Fail("a finite number");
  return number;
}

int64_t JsonNode::Integer() const {
  const double number = Number();
  if (number != std::floor(number) || std::abs(number) > 9e15) Fail("an integer");
  return static_cast<int64_t>(number);
}

int JsonNode::Int() const {
  const int64_t value = Integer();
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    Fail("a whole number of at most 9 digits");
  }
  return static_cast<int>(value);
}

bool JsonNode::Flag() const {
  if (!value_->is_boolean()) Fail("true or false");
  return value_->get<bool>();
}

std::string JsonNode::Text() const {
  if (!value_->is_string()) Fail("text");
  return value_->get<std::string>();
}

void JsonNode::AppendNumbers(const json& value, std::vector<double>* numbers) const {
  if (value.is_array()) {
    for (const json& item : value) AppendNumbers(item, numbers);
    return;
  }
  if (!value.is_number()) {
    throw std::runtime_error(place_ + ": found " + KindName(value) + " after " + std::to_string(numbers->size()) +
                             " numbers, expected only numbers");
  }
  const double number = value.get<double>();
  if (!std::isfinite(number)) Fail("finite numbers");
  numbers->push_back(number);
}

std::vector<double> JsonNode::Numbers(int expected_count) const {
  if (!value_->is_array()) Fail("an array of numbers");
  std::vector<double> numbers;
  AppendNumbers(*value_, &numbers);
  if (expected_count >= 0 && numbers.size() != static_cast<size_t>(expected_count)) {
    throw std::runtime_error(place_ + ": " + std::to_string(numbers.size()) + " numbers, expected " +
                             std::to_string(expected_count));
  }
  return numbers;
}

void JsonNode::Fail(const std::string& expected) const {
  throw std::runtime_error(place_ + ": found " + KindName(*value_) + ", expected " + expected);
}

}  // namespace bodyloom
