// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/protobuf.h"

#include <bit>
#include <cstring>
#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie");

constexpr uint64_t kLargestNumber = (1U << 29) - 1;  // largest field number of the format

}  // namespace

void ProtoMessage::Fail(const std::string& what) const {
  throw std::runtime_error(Concatenate(place_, ": byte ", at_, ": ", what));
}

uint64_t ProtoMessage::Varint() {
  uint64_t value = 0;
  for (int shift = 0; shift < 70; shift += 7) {
    if (at_ == bytes_.size()) Fail("the file ends within a number");
    const auto byte = uint8_t(bytes_[at_++]);
    value |= uint64_t(byte & 127U) << shift;
    if (byte < 128) return value;
  }
  Fail("a number of more than ten bytes");
}

uint64_t ProtoMessage::Fixed(size_t size) {
  if (bytes_.size() - at_ < size) Fail(Concatenate(bytes_.size() - at_, " bytes left, expected ", size));
  uint64_t value = 0;
  std::memcpy(&value, bytes_.data() + at_, size);
  at_ += size;
  return value;
}

bool ProtoMessage::Next(ProtoField* field) {
  if (at_ == bytes_.size()) return false;
  const uint64_t key = Varint();
  if (key >> 3 == 0 || key >> 3 > kLargestNumber) Fail(Concatenate("field ", key >> 3, ", expected 1 to 2^29 - 1"));
  *field = {.number = uint32_t(key >> 3), .kind = ProtoKind(key & 7), .value = 0, .bytes = {}};
  switch (field->kind) {
    case ProtoKind::kVarint:
      field->value = Varint();
      return true;
    case ProtoKind::kFixed64:
      field->value = Fixed(8);
      return true;
    case ProtoKind::kFixed32:
      field->value = Fixed(4);
      return true;
    case ProtoKind::kBytes: {
      const uint64_t size = Varint();
      if (size > bytes_.size() - at_) {
        Fail(Concatenate("field ", field->number, " of ", size, " bytes, ", bytes_.size() - at_, " are left"));
      }
      field->bytes = bytes_.substr(at_, size);
      at_ += size;
      return true;
    }
  }
  Fail(Concatenate("field ", field->number, " of kind ", key & 7, ", expected 0, 1, 2 or 5"));
}

std::string_view ProtoMessage::Bytes(const ProtoField& field) const {
  if (field.kind != ProtoKind::kBytes) Fail(Concatenate("field ", field.number, " is a number, expected bytes"));
  return field.bytes;
}

int64_t ProtoMessage::Integer(const ProtoField& field) const {
  if (field.kind != ProtoKind::kVarint) Fail(Concatenate("field ", field.number, ": expected a whole number"));
  return int64_t(field.value);
}

void ProtoMessage::AddIntegers(const ProtoField& field, std::vector<int64_t>* to) const {
  if (field.kind != ProtoKind::kBytes) {
    to->push_back(Integer(field));
    return;
  }
  ProtoMessage packed(field.bytes, place_);
  while (packed.at_ < packed.bytes_.size()) to->push_back(int64_t(packed.Varint()));
}

void ProtoMessage::AddFloats(const ProtoField& field, std::vector<float>* to) const {
  if (field.kind == ProtoKind::kFixed32) {
    to->push_back(std::bit_cast<float>(uint32_t(field.value)));
    return;
  }
  if (field.kind != ProtoKind::kBytes || field.bytes.size() % sizeof(float) != 0) {
    Fail(Concatenate("field ", field.number, ": expected float32 numbers"));
  }
  if (field.bytes.empty()) return;
  const size_t before = to->size();
  to->resize(before + field.bytes.size() / sizeof(float));
  std::memcpy(to->data() + before, field.bytes.data(), field.bytes.size());
}

}  // namespace bodyloom
