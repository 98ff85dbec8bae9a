// SPDX-License-Identifier: Apache-2.0
/// Builds joblib.dump files byte by byte, for tests without Python.
#pragma once

#include <zlib.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/data_tools/formats/pickle_writer.h"

namespace bodyloom::joblib_stream {

using namespace pickle_writer;  // NOLINT(google-build-using-namespace): opcodes read like the stream they build

/// Builder of a pickle. Array bytes are padded by their position in the file, so values are appended in order.
class JoblibStream {
 public:
  /// `aligned`: with padding, as in joblib 1.2 and later.
  explicit JoblibStream(bool aligned = true) : aligned_(aligned), bytes_("\x80\x04", 2) {}

  JoblibStream& Add(const std::string& opcodes) {
    bytes_ += opcodes;
    return *this;
  }
  /// Appends the wrapper object, its state, and then the raw elements.
  JoblibStream& AddArray(const std::string& dtype, char order, const std::vector<int>& shape, const std::string& raw,
                         bool fortran_order = false) {
    Items state = {{Unicode("subclass"), Global("numpy", "ndarray")},
                   {Unicode("shape"), Shape(shape)},
                   {Unicode("order"), Unicode(fortran_order ? "F" : "C")},
                   {Unicode("dtype"), Dtype2(dtype, order)},
                   {Unicode("allow_mmap"), "\x88"}};
    if (aligned_) state.emplace_back(Unicode("numpy_array_alignment_bytes"), "K\x10");
    bytes_ += Global("joblib.numpy_pickle", "NumpyArrayWrapper") + ")\x81" + Dict(state) + "b";
    if (aligned_) {
      const size_t padding = 16 - (bytes_.size() + 1) % 16;
      bytes_ += static_cast<char>(padding) + std::string(padding, '\xff');
    }
    bytes_ += raw;
    return *this;
  }
  JoblibStream& AddFloats(const std::vector<float>& values, const std::vector<int>& shape) {
    return AddArray("f4", '<', shape, RawOf(values));
  }
  JoblibStream& AddInts(const std::vector<int64_t>& values) {
    return AddArray("i8", '<', {static_cast<int>(values.size())}, RawOf(values));
  }
  [[nodiscard]] std::string Finish() const { return bytes_ + "."; }

 private:
  bool aligned_;
  std::string bytes_;
};

/// joblib.dump(…, compress=3): the whole file as one zlib stream.
inline std::string Compressed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                bytes.size(), 3) != Z_OK) {
    throw std::logic_error("zlib cannot compress");
  }
  packed.resize(size);
  return packed;
}

}  // namespace bodyloom::joblib_stream
