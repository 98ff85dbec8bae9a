// SPDX-License-Identifier: Apache-2.0
/// Paths of folders and programs that tests use.
#pragma once

#include <string>

namespace bodyloom {

/// The checkout.
std::string SourceDir();

/// Real recordings beside the checkout. Users do not have the folder: tests that need it are skipped.
std::string SharedDir();

/// The `bodyloom` executable; "" in a build without apps/.
std::string CommandPath();

}  // namespace bodyloom
