// SPDX-License-Identifier: Apache-2.0
/// `bodyloom train motion`: the motion-dependent renderer of one person, from one clip.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds `motion` below `train`; `action` is set when the user chose it.
void AddTrainMotion(CLI::App& train, std::function<void()>* action);

}  // namespace bodyloom
