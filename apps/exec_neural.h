// SPDX-License-Identifier: Apache-2.0
/// Hands a verb over to the executable that is linked with LibTorch.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// Replaces this process by `bodyloom-neural` with these arguments. Returns only by throwing std::runtime_error: it is
/// not there, or cannot be started.
[[noreturn]] void ExecNeural(const std::vector<std::string>& arguments);

}  // namespace bodyloom
