// SPDX-License-Identifier: Apache-2.0
/// `bodyloom animate animate`.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds the verb to `animate`; when it is chosen, *action becomes what to run.
void AddAnimateGuided(CLI::App& animate, std::function<void()>* action);

}  // namespace bodyloom
