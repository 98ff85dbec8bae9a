// SPDX-License-Identifier: Apache-2.0
/// How a camera was held: the display matrix of MP4 and MOV files (ISO/IEC 14496-12, 8.3.2: "tkhd"), of which phones
/// use the turns by 90 degrees and the mirror images.
#pragma once

#include <cstdint>

namespace bodyloom {

/// First the stored picture is transposed, then its columns, then its rows are put into the opposite order.
struct DisplayOrientation {
  bool transpose = false, flip_columns = false, flip_rows = false;
  bool operator==(const DisplayOrientation&) const = default;
};

/// The orientation nearest to a matrix {a b u, c d v, x y w} by rows, which takes column p and row q of the stored
/// picture to column a·p + c·q + x and row b·p + d·q + y of the shown one. Null: as stored.
DisplayOrientation OrientationOf(const int32_t* matrix);

}  // namespace bodyloom
