// SPDX-License-Identifier: Apache-2.0
/// Whole numbers in the header of an image file. Internal to data_tools/video.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace bodyloom {

/// Whole numbers of a file's bytes; beyond the end there are zeros.
class HeaderBytes {
 public:
  explicit HeaderBytes(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool Has(size_t at, std::string_view text) const {
    return bytes_.size() >= at + text.size() && bytes_.substr(at, text.size()) == text;
  }
  [[nodiscard]] uint64_t Number(size_t at, int count, bool big_endian) const {
    uint64_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | Byte(at + (big_endian ? i : count - 1 - i));
    return value;
  }
  [[nodiscard]] uint64_t Big(size_t at, int count) const { return Number(at, count, true); }
  [[nodiscard]] uint64_t Little(size_t at, int count) const { return Number(at, count, false); }
  [[nodiscard]] size_t size() const { return bytes_.size(); }

 private:
  [[nodiscard]] uint8_t Byte(size_t at) const { return at < bytes_.size() ? static_cast<uint8_t>(bytes_[at]) : 0; }
  std::string_view bytes_;
};

}  // namespace bodyloom
