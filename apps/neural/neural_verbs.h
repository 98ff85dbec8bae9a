// SPDX-License-Identifier: Apache-2.0
/// The verbs that need LibTorch, one file each (apps/neural/NAME.cc).
/// An Add function adds its verb to the parser and, when the user chose it, sets `action` to what is to be done.
#pragma once

#include "apps/verbs.h"

namespace bodyloom {

void AddCard(CLI::App& app, Action* action);

// Below `train`.
void AddTrainLifter(CLI::App& train, Action* action);
void AddTrainMotion(CLI::App& train, Action* action);
void AddTrainPhoto(CLI::App& train, Action* action);
void AddTrainGuided(CLI::App& train, Action* action);
void AddTrainParser(CLI::App& train, Action* action);

// Below `animate`.
void AddAnimateMotion(CLI::App& animate, Action* action);
void AddAnimatePhoto(CLI::App& animate, Action* action);
void AddAnimateGuided(CLI::App& animate, Action* action);
/// `animate person` with --score alone.
void AddScorePerson(CLI::App& animate, Action* action);

}  // namespace bodyloom
