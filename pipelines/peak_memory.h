// SPDX-License-Identifier: Apache-2.0
/// Peak memory of a job.
#pragma once

#include <cstddef>

namespace bodyloom {

/// Largest resident size of this process so far, bytes.
size_t PeakMemoryBytes();

}  // namespace bodyloom
