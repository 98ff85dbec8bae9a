// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/json_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"

namespace bodyloom {

using nlohmann::json;

namespace {

[[noreturn]] void FailAt(const std::string& where, size_t byte, const std::string& message) {
  throw std::runtime_error(where + ": byte " + std::to_string(byte) + ": " + message);
}

/// Layout of a text, from one walk over it.
struct JsonScan {
  std::vector<size_t> nan_begins;                 ///< bytes of NaN, Infinity (behind a minus sign, if it has one)
  std::vector<std::pair<size_t, size_t>> values;  ///< [begin, end) of each array or object that is not inside another
  bool is_cut = false;                            ///< the text ends inside a value, which `values` does not have
  size_t cut_begin = 0;                           ///< the byte at which that value begins
};

/// Walks the text once, string-aware. Up to the first syntax error the count equals the parser's own depth, so a parser
/// that runs afterwards never builds deeper than the limit.
JsonScan ScanJson(const std::string& text, const std::string& where, const JsonLimits& limits) {
  if (text.size() > limits.max_bytes) {
    throw std::runtime_error(where + ": " + std::to_string(text.size()) + " bytes of JSON, at most " +
                             std::to_string(limits.max_bytes) + " are read");
  }
  JsonScan scan;
  int depth = 0;
  size_t begin = 0;
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
      if (depth == 0) begin = i;
      if (++depth > limits.max_depth) {
        FailAt(where, i, "nested deeper than " + std::to_string(limits.max_depth) + " levels");
      }
    } else if (c == ']' || c == '}') {
      if (--depth == 0) scan.values.emplace_back(begin, i + 1);
    } else if (c == 'N' || c == 'I') {
      const bool is_nan = text.compare(i, 3, "NaN") == 0, is_infinity = text.compare(i, 8, "Infinity") == 0;
      if (!limits.nan_is_null || !(is_nan || is_infinity)) {
        FailAt(where, i, "found NaN or Infinity, which JSON does not have; expected a finite number or null");
      }
      scan.nan_begins.push_back(i);
      i += is_nan ? 2 : 7;
    }
  }
  scan.is_cut = depth > 0;
  scan.cut_begin = begin;
  return scan;
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

/// Parses bytes [begin, end) of the text.
json ParsePiece(const std::string& text, size_t begin, size_t end, const JsonScan& scan, const std::string& where) {
  const auto first = std::lower_bound(scan.nan_begins.begin(), scan.nan_begins.end(), begin);
  const auto last = std::lower_bound(first, scan.nan_begins.end(), end);
  // "null" is one byte longer than NaN; blanks make it as long as Infinity.
  std::string replaced;
  std::vector<size_t> longer;  // ends of the longer ones in `replaced`
  size_t copied = begin;
  for (auto nan = first; nan != last; ++nan) {
    const bool is_nan = text[*nan] == 'N', is_negative = *nan > begin && text[*nan - 1] == '-';
    replaced.append(text, copied, *nan - copied);
    if (is_negative) replaced.back() = ' ';
    replaced += is_nan ? "null" : "null    ";
    if (is_nan) longer.push_back(replaced.size());
    copied = *nan + (is_nan ? 3 : 8);
  }
  if (first != last) replaced.append(text, copied, end - copied);
  try {
    const char* data = first != last ? replaced.data() : text.data() + begin;
    return json::parse(data, data + (first != last ? replaced.size() : end - begin));
  } catch (const json::parse_error& error) {
    const auto before = std::lower_bound(longer.begin(), longer.end(), error.byte) - longer.begin();
    FailAt(where, begin + error.byte - size_t(before), "not valid JSON: " + Reason(error));
  } catch (const json::exception& error) {
    throw std::runtime_error(where + ": not usable JSON: " + Reason(error));
  }
}

/// Throws unless bytes [begin, end) of the text are blanks.
void RequireBlanks(const std::string& text, size_t begin, size_t end, const std::string& where) {
  const size_t found = text.find_first_not_of(" \t\r\n", begin);
  if (found < end) FailAt(where, found, "found '" + PrintableText(text.substr(found, 1)) + "' between two JSON values");
}

}  // namespace

json ParseJson(const std::string& text, const std::string& where, const JsonLimits& limits) {
  return ParsePiece(text, 0, text.size(), ScanJson(text, where, limits), where);
}

json ParseJsonLines(const std::string& text, const std::string& where, const JsonLimits& limits,
                    std::vector<std::string>* warnings) {
  const JsonScan scan = ScanJson(text, where, limits);
  if (scan.values.size() + (scan.is_cut ? 1 : 0) < 2) return ParsePiece(text, 0, text.size(), scan, where);
  json lines = json::array();
  size_t end = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  for (const auto& [value_begin, value_end] : scan.values) {
    RequireBlanks(text, end, value_begin, where);
    lines.push_back(ParsePiece(text, value_begin, value_end, scan, where));
    end = value_end;
  }
  RequireBlanks(text, end, scan.is_cut ? scan.cut_begin : text.size(), where);
  if (scan.is_cut && warnings != nullptr) {
    warnings->push_back(where + ": the last of " + std::to_string(scan.values.size() + 1) +
                        " JSON values is cut off and left out");
  }
  return lines;
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

void JsonNode::AppendNumbers(const json& value, bool null_is_nan, std::vector<double>* numbers) const {
  if (value.is_array()) {
    for (const json& item : value) AppendNumbers(item, null_is_nan, numbers);
    return;
  }
  if (null_is_nan && value.is_null()) {
    numbers->push_back(std::numeric_limits<double>::quiet_NaN());
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

std::vector<double> JsonNode::AllNumbers(int expected_count, bool null_is_nan) const {
  if (!value_->is_array()) Fail("an array of numbers");
  std::vector<double> numbers;
  AppendNumbers(*value_, null_is_nan, &numbers);
  if (expected_count >= 0 && numbers.size() != static_cast<size_t>(expected_count)) {
    throw std::runtime_error(place_ + ": " + std::to_string(numbers.size()) + " numbers, expected " +
                             std::to_string(expected_count));
  }
  return numbers;
}

std::vector<double> JsonNode::Numbers(int expected_count) const { return AllNumbers(expected_count, false); }

std::vector<double> JsonNode::NumbersOrNan(int expected_count) const { return AllNumbers(expected_count, true); }

double JsonNode::NumberOrNan() const { return value_->is_null() ? std::numeric_limits<double>::quiet_NaN() : Number(); }

void JsonNode::Fail(const std::string& expected) const {
  throw std::runtime_error(place_ + ": found " + KindName(*value_) + ", expected " + expected);
}

}  // namespace bodyloom
