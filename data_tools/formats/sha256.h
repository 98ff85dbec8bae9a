// SPDX-License-Identifier: Apache-2.0
/// SHA-256 (FIPS 180-4) of contents, by libavutil, which is linked in any case.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace bodyloom {

/// Incremental digest.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void Add(std::string_view bytes);
  /// Adds length (eight bytes, little endian) and bytes, so that different lists of texts never add the same bytes.
  void AddField(std::string_view text);
  /// 64 hexadecimal digits in lower case. Nothing may be added afterwards.
  [[nodiscard]] std::string Hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Digest of a file's contents, read in pieces. Throws std::runtime_error naming a file that cannot be read.
std::string Sha256OfFile(const std::string& path);

/// Digest of a file's contents, or of the names and contents of all files below a folder (FilesBelow()), independent of
/// the folder's location. Throws std::runtime_error naming what cannot be read.
std::string Sha256OfTree(const std::string& path);

}  // namespace bodyloom
