// SPDX-License-Identifier: Apache-2.0
/// `bodyloom train photo`: the one-photo renderer, from pictures of many people.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds `photo` below `train`; `action` is set when the user chose it.
void AddTrainPhoto(CLI::App& train, std::function<void()>* action);

}  // namespace bodyloom
