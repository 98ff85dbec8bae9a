// SPDX-License-Identifier: Apache-2.0
/// Which clips of a manifest are one process's own when several share it.
///
/// Clip k of the manifest, counted from 0, belongs to shard k mod N. That depends on the manifest and N alone: no process
/// has to know of another, and a look at the inputs (their sizes, say) would let two processes that see a folder at
/// different times leave a clip to each other. Neighbours in a manifest are often cuts of one recording, or sorted by
/// length: taking every N-th shares them out evenly.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace bodyloom {

struct Shard {
  int index = 0;  ///< from 0 to count − 1
  int count = 1;

  [[nodiscard]] bool Holds(size_t clip) const {
    return clip % static_cast<size_t>(count) == static_cast<size_t>(index);
  }
};

/// "i/N" with 0 ≤ i < N ≤ 1,000,000. Throws RequestError.
Shard ShardFromText(const std::string& text);

/// Of a task of a Slurm job array: N = SLURM_ARRAY_TASK_COUNT, i = (SLURM_ARRAY_TASK_ID − _MIN) / _STEP, where MIN is 0
/// and STEP 1 when they are not there; none outside an array. `variable` gives a variable's value, null when it is not
/// there (std::getenv). Throws RequestError for an array whose numbers are not evenly spaced (--array=1,3,7), where i
/// does not follow from them, and for values that are no numbers.
std::optional<Shard> ShardFromSlurm(const std::function<const char*(const char*)>& variable);

/// ShardFromText() of a text that is not empty, else ShardFromSlurm(), else the whole.
Shard ChooseShard(const std::string& text, const std::function<const char*(const char*)>& variable);

}  // namespace bodyloom
