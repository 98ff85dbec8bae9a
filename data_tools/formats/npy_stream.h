// SPDX-License-Identifier: Apache-2.0
/// Writes a .npy file record by record, for arrays larger than memory: numpy.load(path, mmap_mode="r") opens it. The
/// file has its full size from the start, so records may be written in any order and by several threads; it appears at
/// its path atomically when Finish() returns.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/ndarray.h"

namespace bodyloom {

class NpyStream {
 public:
  /// An array of `shape` (the first dimension counts the records), elements of `dtype` (numbers). Reserves the disk
  /// space where the file system can, so that a full disk is reported at once. Throws std::runtime_error "path: ..."
  /// when the file cannot be created, std::invalid_argument for a shape that no memory could address.
  NpyStream(const std::string& path, DType dtype, std::vector<int64_t> shape);
  /// Discards everything written if Finish() was not called.
  ~NpyStream();
  NpyStream(const NpyStream&) = delete;
  NpyStream& operator=(const NpyStream&) = delete;

  [[nodiscard]] size_t record_bytes() const { return record_bytes_; }

  /// Writes the record at `index`, given in consecutive pieces. Safe to call from several threads for different
  /// records. Throws std::runtime_error naming the path when the disk is full, std::invalid_argument when the index or
  /// the number of bytes is wrong.
  void Write(int64_t index, std::span<const std::span<const char>> pieces);

  /// Flushes to disk and moves the file into place. Throws std::runtime_error naming the path; std::invalid_argument
  /// when not every record was written.
  void Finish();

 private:
  std::string path_;
  AtomicPath file_;
  int descriptor_ = -1;
  size_t header_bytes_ = 0, record_bytes_ = 0;
  int64_t num_records_ = 0;
  std::atomic<int64_t> num_written_{0};
};

/// Memory-maps the values of a .npy file: pages are read on access and released when memory is short, so an array may
/// be larger than memory.
class MappedNpy {
 public:
  /// The file may be unlinked afterwards; it must not be truncated. Throws std::runtime_error "path: why" for a file
  /// that cannot be opened, is not a .npy, or whose values are not `dtype` in C order, little endian and on multiples
  /// of their size (numpy pads headers so that they are).
  MappedNpy(const std::string& path, DType dtype);

  [[nodiscard]] const std::vector<int64_t>& shape() const { return shape_; }
  /// All values; valid during the lifetime of this object.
  template <class T>
  [[nodiscard]] std::span<const T> Values() const {
    return {reinterpret_cast<const T*>(values_.data()), values_.size() / sizeof(T)};
  }

 private:
  std::vector<int64_t> shape_;
  std::shared_ptr<void> map_;
  std::span<const char> values_;
};

}  // namespace bodyloom
