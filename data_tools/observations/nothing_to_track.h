// SPDX-License-Identifier: Apache-2.0
/// The refusal of a clip that is sound and shows nobody who could be tracked.
#pragma once

#include <stdexcept>

namespace bodyloom {

/// "path: …": the input could be read, and nobody is in it, or nothing could be estimated from what is. A caller who runs
/// many clips tells this apart from a file that cannot be used.
class NothingToTrack : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace bodyloom
