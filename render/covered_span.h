// SPDX-License-Identifier: Apache-2.0
/// The covered span of a row of a visibility buffer: most of a person's box is background, which is passed over eight
/// pixels at a time.
#pragma once

#include <cstdint>

namespace bodyloom {

/// Whether none of eight pixels sees a face.
inline bool SeeNothing(const int32_t* eight_faces) {
  int32_t all = eight_faces[0];
  for (int i = 1; i < 8; ++i) all &= eight_faces[i];  // −1 has every bit
  return all == -1;
}

/// Columns [begin, end) outside of which the row sees nothing; both 0 when it sees nothing at all.
struct CoveredSpan {
  int begin = 0, end = 0;
};

inline CoveredSpan FindCoveredSpan(const int32_t* faces, int width) {
  int begin = 0, end = width;
  while (begin + 8 <= end && SeeNothing(faces + begin)) begin += 8;
  while (begin < end && faces[begin] < 0) ++begin;
  while (end - 8 >= begin && SeeNothing(faces + end - 8)) end -= 8;
  while (end > begin && faces[end - 1] < 0) --end;
  return begin < end ? CoveredSpan{begin, end} : CoveredSpan{};
}

}  // namespace bodyloom
