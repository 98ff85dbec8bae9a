// SPDX-License-Identifier: Apache-2.0
/// Zip archives in memory: stored and deflated members, zip64 sizes and offsets read.
///
/// The reader checks everything: every offset lies inside the file, members do not overlap (so they cannot share one
/// compressed bomb), deflate expands at most 1100:1 (its own limit is 1032:1), sizes and CRC-32 match. Source: PKWARE
/// APPNOTE.TXT 6.3.x; RFC 1951.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

struct ZipMember {
  std::string name;
  std::string bytes;
};

/// True for the four bytes that a zip archive starts with.
bool LooksLikeZip(std::string_view bytes);

/// All members in the order of the archive's directory. Throws std::runtime_error naming `where`, the member and what
/// was expected; together the members take at most max_bytes, which is checked before memory is allocated.
std::vector<ZipMember> ReadZip(std::string_view archive, const std::string& where, size_t max_bytes);

/// Builds an archive member by member, with fixed dates, deflated where that is smaller; equal members give equal
/// bytes. Pieces are not copied before packing: beside them only the archive itself takes memory.
class ZipBuilder {
 public:
  /// Adds a member whose bytes are the concatenated pieces. level 1..9 as in zlib. Throws std::invalid_argument from 4
  /// GiB on.
  void Add(const std::string& name, std::span<const std::string_view> pieces, int level = 6);
  /// Throws std::invalid_argument for archives of 4 GiB and more, or 65535 members.
  [[nodiscard]] std::string Finish() &&;

 private:
  std::string archive_, directory_;
  size_t num_members_ = 0;
};

/// Builds the archive of the members in the given order with ZipBuilder.
std::string MakeZip(const std::vector<ZipMember>& members, int level = 6);

}  // namespace bodyloom
