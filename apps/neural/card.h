// SPDX-License-Identifier: Apache-2.0
/// `bodyloom neural card`: what the networks of a system are made of.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds `card`; `action` is set when the user chose it.
void AddCard(CLI::App& app, std::function<void()>* action);

}  // namespace bodyloom
