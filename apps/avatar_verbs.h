// SPDX-License-Identifier: Apache-2.0
/// `train avatar`, `animate avatar` and `animate person`, which need no LibTorch and so are this command's own, unlike
/// their siblings.
#pragma once

#include "apps/verbs.h"

namespace bodyloom {

void AddTrainAvatar(CLI::App& train, Action* action);
void AddAnimateAvatar(CLI::App& animate, Action* action);
void AddAnimatePerson(CLI::App& animate, Action* action);

}  // namespace bodyloom
