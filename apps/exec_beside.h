// SPDX-License-Identifier: Apache-2.0
/// Hands a verb over to another executable that lies beside this one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bodyloom {

/// Path of the executable called `name` in this one's folder, whether it is there or not.
std::filesystem::path ProgramBeside(const std::string& name);

/// Replaces this process by that executable with these arguments. Returns only when it is not there; throws
/// std::runtime_error when it cannot be started.
void ExecBeside(const std::string& name, const std::vector<std::string>& arguments);

// Hands a verb over to the executable that is linked with LibTorch.

/// Replaces this process by `bodyloom-neural` with these arguments. Returns only by throwing std::runtime_error: it is
/// not there, or cannot be started.
[[noreturn]] void ExecNeural(const std::vector<std::string>& arguments);

}  // namespace bodyloom
