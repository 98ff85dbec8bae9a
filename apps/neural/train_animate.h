// SPDX-License-Identifier: Apache-2.0
/// `bodyloom train animate`.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds the verb to `train`; when it is chosen, *action becomes what to run.
void AddTrainAnimate(CLI::App& train, std::function<void()>* action);

}  // namespace bodyloom
