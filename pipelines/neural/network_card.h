// SPDX-License-Identifier: Apache-2.0
/// Architecture cards of a renderer's networks, which `bodyloom neural card` prints.
#pragma once

#include <string>

namespace bodyloom {

enum class NeuralRenderer { kMotion, kPhoto, kGuided };

/// Names, shapes, parameters and multiply-adds of all layers, a table. `profile`: "paper", "cpu" or "tiny". Throws
/// std::invalid_argument for other names.
std::string NetworkCard(NeuralRenderer renderer, const std::string& profile);

}  // namespace bodyloom
