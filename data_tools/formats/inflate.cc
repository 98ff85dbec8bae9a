// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/inflate.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kInflateStep = size_t{1} << 20;
constexpr int kGzipOrZlib = 15 + 32;  ///< zlib's window bits: the stream's own header tells

}  // namespace

bool LooksLikeGzip(std::string_view bytes) { return bytes.substr(0, 2) == "\x1f\x8b"; }

bool LooksLikeZlib(std::string_view bytes) {
  if (bytes.size() < 2 || bytes[0] != '\x78') return false;
  return (0x7800 + static_cast<unsigned char>(bytes[1])) % 31 == 0;
}

std::string Inflate(std::string_view bytes, const std::string& where, size_t max_bytes) {
  z_stream stream{};
  if (::inflateInit2(&stream, kGzipOrZlib) != Z_OK) throw std::runtime_error(where + ": cannot start zlib");
  struct Closer {
    z_stream* stream;
    ~Closer() { ::inflateEnd(stream); }
  } closer{&stream};
  size_t next = 0;  // of the bytes, which zlib takes in pieces of at most 4 GiB
  std::string contents;
  int status = Z_OK;
  while (status != Z_STREAM_END) {
    if (stream.avail_in == 0) {
      const size_t piece = std::min<size_t>(bytes.size() - next, std::numeric_limits<uInt>::max());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + next));
      stream.avail_in = static_cast<uInt>(piece);
      next += piece;
    }
    const size_t done = contents.size();
    if (done > max_bytes) throw std::runtime_error(Concatenate(where, ": inflates to more than ", max_bytes, " bytes"));
    contents.resize(done + kInflateStep);
    stream.next_out = reinterpret_cast<Bytef*>(contents.data() + done);
    stream.avail_out = static_cast<uInt>(kInflateStep);
    status = ::inflate(&stream, Z_NO_FLUSH);
    contents.resize(done + kInflateStep - stream.avail_out);
    const bool is_stuck = status == Z_BUF_ERROR ||
                          (status == Z_OK && stream.avail_in == 0 && next == bytes.size() && stream.avail_out > 0);
    if ((status != Z_OK && status != Z_STREAM_END) || is_stuck) {
      throw std::runtime_error(Concatenate(where, ": byte ", next - stream.avail_in, ": the ",
                                           LooksLikeGzip(bytes) ? "gzip" : "zlib", " stream is ",
                                           is_stuck ? "cut off" : "damaged"));
    }
  }
  return contents;
}

}  // namespace bodyloom
