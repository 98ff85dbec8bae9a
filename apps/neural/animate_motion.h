// SPDX-License-Identifier: Apache-2.0
/// `bodyloom animate motion`: a person that `bodyloom train motion` learned, in any motion, as a video.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds `motion` below `animate`; `action` is set when the user chose it.
void AddAnimateMotion(CLI::App& animate, std::function<void()>* action);

}  // namespace bodyloom
