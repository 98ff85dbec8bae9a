// SPDX-License-Identifier: Apache-2.0
/// Writes FlatBuffers without a schema: a tree of tables, vectors and text, each followed by what it points to.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

class FlatNode {
 public:
  static FlatNode Table() { return FlatNode(Kind::kTable); }
  static FlatNode List(std::vector<FlatNode> items) {
    FlatNode node(Kind::kList);
    node.children_ = std::move(items);
    return node;
  }
  static FlatNode Text(std::string text) {
    FlatNode node(Kind::kNumbers);
    node.count_ = text.size();
    node.bytes_ = std::move(text);
    return node;
  }
  template <typename T>
  static FlatNode Numbers(const std::vector<T>& values) {
    FlatNode node(Kind::kNumbers);
    node.count_ = values.size();
    node.bytes_.assign(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return node;
  }

  /// A number of at most 32 bits; small ones are read from the first byte of the four.
  FlatNode& Set(int field, int32_t value) {
    numbers_.emplace_back(field, value);
    return *this;
  }
  FlatNode& Set(int field, FlatNode child) {
    child_fields_.push_back(field);
    children_.push_back(std::move(child));
    return *this;
  }

  /// The file with this table as its root.
  [[nodiscard]] std::string File(const std::string& identifier) const {
    std::string out(4, '\0');
    out += identifier;
    Put(&out, 0, static_cast<uint32_t>(Write(&out)));
    return out;
  }

 private:
  enum class Kind { kTable, kNumbers, kList };
  explicit FlatNode(Kind kind) : kind_(kind) {}

  template <typename T>
  static void Put(std::string* out, size_t at, T value) {
    std::memcpy(out->data() + at, &value, sizeof(T));
  }

  /// Appends the node and its descendants; returns its offset.
  size_t Write(std::string* out) const {  // NOLINT(misc-no-recursion)
    out->append((4 - out->size() % 4) % 4, '\0');
    size_t at = out->size(), slots = at + 4;
    if (kind_ == Kind::kNumbers) {
      out->append(4, '\0');
      Put(out, at, static_cast<uint32_t>(count_));
      *out += bytes_;
      return at;
    }
    std::vector<size_t> places;  // of the children's offsets
    if (kind_ == Kind::kList) {
      out->append(4 + 4 * children_.size(), '\0');
      Put(out, at, static_cast<uint32_t>(children_.size()));
      for (size_t i = 0; i < children_.size(); ++i) places.push_back(slots + 4 * i);
    } else {
      int last = -1;
      for (const auto& [field, value] : numbers_) last = std::max(last, field);
      for (const int field : child_fields_) last = std::max(last, field);
      const size_t list = at, list_bytes = 4 + 2 * static_cast<size_t>(last + 1);
      const size_t table_bytes = 4 + 4 * (numbers_.size() + children_.size());
      at = list + (list_bytes + 3) / 4 * 4;
      out->append(at + table_bytes - list, '\0');
      Put(out, list, static_cast<uint16_t>(list_bytes));
      Put(out, list + 2, static_cast<uint16_t>(table_bytes));
      Put(out, at, static_cast<int32_t>(at - list));
      slots = at + 4;
      for (const auto& [field, value] : numbers_) {
        Put(out, list + 4 + 2 * static_cast<size_t>(field), static_cast<uint16_t>(slots - at));
        Put(out, slots, value);
        slots += 4;
      }
      for (const int field : child_fields_) {
        Put(out, list + 4 + 2 * static_cast<size_t>(field), static_cast<uint16_t>(slots - at));
        places.push_back(slots);
        slots += 4;
      }
    }
    for (size_t i = 0; i < children_.size(); ++i) {
      const size_t child = children_[i].Write(out);
      Put(out, places[i], static_cast<uint32_t>(child - places[i]));
    }
    return at;
  }

  Kind kind_;
  std::vector<std::pair<int, int32_t>> numbers_;
  std::vector<int> child_fields_;
  std::vector<FlatNode> children_;
  std::string bytes_;
  size_t count_ = 0;
};

}  // namespace bodyloom
