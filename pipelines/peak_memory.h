// SPDX-License-Identifier: Apache-2.0
/// How much memory a job took.
#pragma once

#include <cstddef>

namespace bodyloom {

/// Largest resident size of this process so far, bytes.
size_t PeakMemoryBytes();

}  // namespace bodyloom
