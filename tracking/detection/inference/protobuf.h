// SPDX-License-Identifier: Apache-2.0
/// Reads Protocol Buffers in place: the fields of a message in sequence, without the schema and without a copy.
///
/// A message is a sequence of fields. Each begins with a varint (7 bits a byte, the least significant first, the top
/// bit set on all but the last of at most ten): 8 · number + kind. Kind 0: another varint. 1: eight bytes. 5: four
/// bytes. 2: a varint that counts the bytes which follow: text, a message, or an array of numbers ("packed"). Fields
/// come in any order and any number of times. Little endian. Source: protobuf.dev, "Encoding".
///
/// Every length is checked before it is used; one that leaves the message throws std::runtime_error "place: byte N:
/// what was found, expected what". Kinds 3 and 4 (groups) are refused.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

enum class ProtoKind : uint8_t { kVarint = 0, kFixed64 = 1, kBytes = 2, kFixed32 = 5 };

struct ProtoField {
  uint32_t number = 0;
  ProtoKind kind = ProtoKind::kVarint;
  uint64_t value = 0;      ///< of kinds other than kBytes
  std::string_view bytes;  ///< of kBytes
};

/// Iterates over the fields of a message; the bytes must outlive it. Error messages begin with `place`.
class ProtoMessage {
 public:
  ProtoMessage(std::string_view bytes, std::string place) : bytes_(bytes), place_(std::move(place)) {}

  /// Reads the next field; false at the end.
  bool Next(ProtoField* field);

  /// The field's bytes. Throws when it holds a number.
  [[nodiscard]] std::string_view Bytes(const ProtoField& field) const;
  /// The field's varint. Throws when it is of another kind.
  [[nodiscard]] int64_t Integer(const ProtoField& field) const;
  /// Appends the field's whole numbers, one or packed.
  void AddIntegers(const ProtoField& field, std::vector<int64_t>* to) const;
  /// Appends the field's float32 numbers, one or packed.
  void AddFloats(const ProtoField& field, std::vector<float>* to) const;

  [[nodiscard]] const std::string& place() const { return place_; }

 private:
  uint64_t Varint();
  uint64_t Fixed(size_t size);
  [[noreturn]] void Fail(const std::string& what) const;

  std::string_view bytes_;
  std::string place_;
  size_t at_ = 0;
};

}  // namespace bodyloom
