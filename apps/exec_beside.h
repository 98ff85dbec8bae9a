// SPDX-License-Identifier: Apache-2.0
/// Hands a verb over to another executable in the same folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bodyloom {

/// Path of the executable `name` in this executable's folder, whether or not it exists.
std::filesystem::path ProgramBeside(const std::string& name);

/// Replaces this process by that executable with these arguments. Returns only if it does not exist; throws
/// std::runtime_error when it cannot be started.
void ExecBeside(const std::string& name, const std::vector<std::string>& arguments);

/// Replaces this process by `bodyloom-neural`, which is linked with LibTorch, with these arguments. Throws
/// std::runtime_error if it does not exist or cannot be started; never returns otherwise.
[[noreturn]] void ExecNeural(const std::vector<std::string>& arguments);

}  // namespace bodyloom
