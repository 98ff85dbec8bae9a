// SPDX-License-Identifier: Apache-2.0
/// Verbs of the command, one file each (apps/verb_*.cc). An Add function adds its verb to the parser; if the user chose
/// the verb, it sets `action` to its job, which main() runs after parsing. An action returns normally on success and
/// throws otherwise (apps/usage_error.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipelines/body/check_body.h"
#include "pipelines/detect/detect_dense.h"

namespace CLI {
class App;
}

namespace bodyloom {

struct FrameMetric;

using Action = std::function<void()>;

void AddRunVerb(CLI::App& app, Action* action);
void AddLiveVerb(CLI::App& app, Action* action);
void AddBatchVerb(CLI::App& app, Action* action);
/// Dense keypoints need LibTorch: `dense` makes their detector from --dense-model, --device and --dense-colours (""
/// when not given). Without `dense` the command is handed over to the executable that has it, with `arguments`, those
/// of this process.
using MakeChartDetector =
    std::function<ChartDetector(const std::string& model, const std::string& device, const std::string& colours)>;
void AddDetectVerb(CLI::App& app, Action* action, std::vector<std::string> arguments, MakeChartDetector dense = {});
void AddTrackVerb(CLI::App& app, Action* action);
void AddSynthVerb(CLI::App& app, Action* action);
void AddSynthPersonVerb(CLI::App& app, Action* action);
void AddSynthPeopleVerb(CLI::App& app, Action* action);
void AddEvaluateVerb(CLI::App& app, Action* action);
/// Metrics that need LibTorch are made by `more` (with the folder of --weights). Without it the command is handed over
/// to the executable that has them, with `arguments`, those of this process.
using MoreMetrics = std::function<std::vector<FrameMetric>(const std::string& weights)>;
void AddMetricsVerb(CLI::App& app, Action* action, std::vector<std::string> arguments, MoreMetrics more = {});
void AddExportVerb(CLI::App& app, Action* action);
void AddRenderVerb(CLI::App& app, Action* action);
void AddDescribeVerb(CLI::App& app, Action* action);
void AddTextureVerb(CLI::App& app, Action* action);
void AddParseVerb(CLI::App& app, Action* action);
/// `tools` find intersecting faces of a body and fill its holes. Without them `info --check` is handed over to the
/// executable that has them, if installed, with `arguments`, those of this process.
void AddBodyVerb(CLI::App& app, Action* action, const std::vector<std::string>& arguments, SurfaceTools tools = {});
/// `body info`, below the verb `body`.
void AddBodyInfo(CLI::App& verb, Action* action, const std::vector<std::string>& arguments, SurfaceTools tools);
void AddDemoVerb(CLI::App& app, Action* action);
void AddPriorVerb(CLI::App& app, Action* action);
void AddMotionsVerb(CLI::App& app, Action* action);
void AddTrainVerb(CLI::App& app, Action* action);
/// `arguments`: those of this process, for verbs handed over to another executable.
void AddAnimateVerb(CLI::App& app, Action* action, std::vector<std::string> arguments);
void AddNeuralVerb(CLI::App& app, Action* action);
void AddVersionVerb(CLI::App& app, Action* action);

// `train avatar`, `animate avatar` and `animate person`, which need no LibTorch and run in this executable, unlike the
// other verbs below `train` and `animate`.

void AddTrainAvatar(CLI::App& train, Action* action);
void AddAnimateAvatar(CLI::App& animate, Action* action);
/// Scores need LibTorch: with --score the command is handed over to the executable that has them, with `arguments`,
/// those of this process.
void AddAnimatePerson(CLI::App& animate, Action* action, std::vector<std::string> arguments);

}  // namespace bodyloom
