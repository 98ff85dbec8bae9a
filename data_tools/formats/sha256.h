// SPDX-License-Identifier: Apache-2.0
/// SHA-256 (FIPS 180-4), which tells contents apart: by libavutil, which is linked in any case.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace bodyloom {

/// The digest of bytes that come piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void Add(std::string_view bytes);
  /// Length (eight bytes, the lowest first) and bytes: of a list of texts, no two lists give the same digest.
  void AddField(std::string_view text);
  /// 64 hexadecimal digits in lower case. Nothing may be added afterwards.
  [[nodiscard]] std::string Hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Of a file's contents, read in pieces. Throws std::runtime_error naming a file that cannot be read.
std::string Sha256OfFile(const std::string& path);

/// Of a file, that of its contents; of a folder, that of the names and contents of all files below it (FilesBelow()),
/// so that it is the same wherever the folder lies. Throws std::runtime_error naming what cannot be read.
std::string Sha256OfTree(const std::string& path);

}  // namespace bodyloom
