// SPDX-License-Identifier: Apache-2.0
#include "tests/support/paths.h"

namespace bodyloom {

std::string SourceDir() { return BODYLOOM_SOURCE_DIR; }

std::string SharedDir() { return BODYLOOM_SHARED_DIR; }

std::string CommandPath() { return BODYLOOM_EXECUTABLE; }

}  // namespace bodyloom
