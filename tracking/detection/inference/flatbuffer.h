// SPDX-License-Identifier: Apache-2.0
/// Reads FlatBuffers in place: tables, vectors and text by field number, without the schema and without a copy.
///
/// A file begins with the place of its root table (uint32, bytes from there on) and four letters that name the format.
/// A table begins with an int32: its own place less this number is its list of fields (uint16: bytes of the list, bytes
/// of the table, then the place of each field within the table, 0 = absent). A field is a number, or a uint32 that
/// counts bytes from itself on to a table, or to a vector or text (uint32 count, then the elements). All numbers are
/// little endian. Source: google/flatbuffers, docs "FlatBuffer internals".
///
/// Every place and count is checked before it is used; one that leaves the file throws std::runtime_error "name: table
/// at byte N, field N: what was found, expected what". Offsets are followed only on request, so cycles are harmless;
/// but parts may be shared, so callers must bound the total size of their copies.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace bodyloom {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie");

/// View of an array of numbers in the file; the file's bytes must outlive it.
template <typename T>
class FlatNumbers {
 public:
  static_assert(std::is_arithmetic_v<T>);
  FlatNumbers() = default;
  explicit FlatNumbers(std::string_view bytes) : bytes_(bytes) {}
  [[nodiscard]] size_t size() const { return bytes_.size() / sizeof(T); }
  [[nodiscard]] T operator[](size_t i) const {
    T value;
    std::memcpy(&value, bytes_.data() + i * sizeof(T), sizeof(T));
    return value;
  }

 private:
  std::string_view bytes_;
};

/// A table of a file; the file's bytes and name must outlive it.
class FlatTable {
 public:
  /// The root table of a file whose bytes 4 to 7 are `identifier`. Throws when they are not.
  static FlatTable Root(std::string_view file, std::string_view identifier, const std::string& name);

  [[nodiscard]] bool Has(int field) const { return FieldAt(field, 0) != 0; }

  /// A number; `absent` when the table lacks the field, as FlatBuffers store no defaults.
  template <typename T>
  [[nodiscard]] T Number(int field, T absent) const {
    const size_t at = FieldAt(field, sizeof(T));
    if (at == 0) return absent;
    T value;
    std::memcpy(&value, file_.data() + at, sizeof(T));
    return value;
  }

  [[nodiscard]] std::optional<FlatTable> Table(int field) const;

  /// Numbers of a vector; none when the table lacks the field.
  template <typename T>
  [[nodiscard]] FlatNumbers<T> Numbers(int field) const {
    return FlatNumbers<T>(Vector(field, sizeof(T)));
  }

  /// Bytes of a vector of bytes or of text (without its closing zero); none when the table lacks the field.
  [[nodiscard]] std::string_view Bytes(int field) const { return Vector(field, 1); }

  /// Tables of a vector; none when the table lacks the field. More than `max_count` are refused.
  [[nodiscard]] std::vector<FlatTable> Tables(int field, size_t max_count) const;

  /// "table at byte N", for messages.
  [[nodiscard]] std::string Place() const;

 private:
  FlatTable(std::string_view file, size_t at, const std::string& name);
  /// Place in the file of a field that holds `bytes` bytes; 0 when the table lacks it.
  [[nodiscard]] size_t FieldAt(int field, size_t bytes) const;
  /// Target of the offset at this position.
  [[nodiscard]] size_t Follow(size_t at, int field) const;
  [[nodiscard]] std::string_view Vector(int field, size_t element_bytes) const;
  [[noreturn]] void Fail(int field, const std::string& message) const;

  std::string_view file_;
  const std::string* name_;
  size_t at_;          ///< of the table
  size_t fields_;      ///< of its list of fields
  size_t num_fields_;  ///< that the list names
};

}  // namespace bodyloom
