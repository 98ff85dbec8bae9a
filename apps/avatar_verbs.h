// SPDX-License-Identifier: Apache-2.0
/// `train avatar` and `animate avatar`, which need no LibTorch and so are this command's own, unlike their siblings.
#pragma once

#include "apps/verbs.h"

namespace bodyloom {

void AddTrainAvatar(CLI::App& train, Action* action);
void AddAnimateAvatar(CLI::App& animate, Action* action);

}  // namespace bodyloom
