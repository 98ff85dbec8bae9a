// SPDX-License-Identifier: Apache-2.0
/// `bodyloom train lifter`: from a folder of recorded motion to the weights of the lifter.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds `lifter` below `train`; `action` is set when the user chose it.
void AddTrainLifter(CLI::App& train, std::function<void()>* action);

}  // namespace bodyloom
