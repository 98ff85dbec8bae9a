// SPDX-License-Identifier: Apache-2.0
/// Verbs that need LibTorch, one file each (apps/neural/NAME.cc). An Add function adds its verb to the parser; if the
/// user chose the verb, it sets `action` to its job.
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
/// `animate person`, only with --score.
void AddScorePerson(CLI::App& animate, Action* action);

}  // namespace bodyloom
