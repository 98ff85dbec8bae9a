// SPDX-License-Identifier: Apache-2.0
/// Folders and programs that tests open.
#pragma once

#include <string>

namespace bodyloom {

/// The checkout.
std::string SourceDir();

/// Real recordings beside the checkout. Users do not have the folder: what needs it skips where it is missing.
std::string SharedDir();

/// The `bodyloom` executable; "" in a build without apps/.
std::string CommandPath();

}  // namespace bodyloom
