// SPDX-License-Identifier: Apache-2.0
/// `bodyloom animate photo`: a person from one photo, in any motion.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds `photo` below `animate`; `action` is set when the user chose it.
void AddAnimatePhoto(CLI::App& animate, std::function<void()>* action);

}  // namespace bodyloom
