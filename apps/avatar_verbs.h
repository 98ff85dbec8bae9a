// SPDX-License-Identifier: Apache-2.0
/// `train avatar`, `animate avatar` and `animate person`, which need no LibTorch and so are this command's own, unlike
/// their siblings.
#pragma once

#include "apps/verbs.h"

namespace bodyloom {

void AddTrainAvatar(CLI::App& train, Action* action);
void AddAnimateAvatar(CLI::App& animate, Action* action);
/// Scores need LibTorch: with --score the command goes on in the executable that has them, which takes `arguments`, those
/// of this one.
void AddAnimatePerson(CLI::App& animate, Action* action, std::vector<std::string> arguments);

}  // namespace bodyloom
