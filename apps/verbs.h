// SPDX-License-Identifier: Apache-2.0
/// The verbs of the command, one file each (apps/verb_*.cc).
/// An Add function describes its verb to the parser and, when the user chose it, sets `action` to what is to be done;
/// main() runs it after parsing. An action returns normally on success and throws otherwise (apps/usage_error.h).
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
void AddBatchVerb(CLI::App& app, Action* action);
/// Dense keypoints need LibTorch: their detector comes from `dense`, given --dense-model, --device and --dense-colours
/// ("" when not said); without it the command goes on in the executable that has it, which takes `arguments`, those of
/// this one.
using MakeChartDetector =
    std::function<ChartDetector(const std::string& model, const std::string& device, const std::string& colours)>;
void AddDetectVerb(CLI::App& app, Action* action, std::vector<std::string> arguments, MakeChartDetector dense = {});
void AddTrackVerb(CLI::App& app, Action* action);
void AddSynthVerb(CLI::App& app, Action* action);
void AddSynthPersonVerb(CLI::App& app, Action* action);
void AddSynthPeopleVerb(CLI::App& app, Action* action);
void AddEvaluateVerb(CLI::App& app, Action* action);
/// Metrics that need LibTorch are requested from `more` (with the folder of --weights); without it the command goes on
/// in the executable that has them, which takes `arguments`, those of this one.
using MoreMetrics = std::function<std::vector<FrameMetric>(const std::string& weights)>;
void AddMetricsVerb(CLI::App& app, Action* action, std::vector<std::string> arguments, MoreMetrics more = {});
void AddExportVerb(CLI::App& app, Action* action);
void AddRenderVerb(CLI::App& app, Action* action);
void AddDescribeVerb(CLI::App& app, Action* action);
void AddTextureVerb(CLI::App& app, Action* action);
void AddParseVerb(CLI::App& app, Action* action);
/// `tools` find the faces of a body that cross each other and close its holes; without them `info --check` goes on in
/// the executable that has them, where there is one, which takes `arguments`, those of this one.
void AddBodyVerb(CLI::App& app, Action* action, const std::vector<std::string>& arguments, SurfaceTools tools = {});
/// `body info`, of the verb `body`.
void AddBodyInfo(CLI::App& verb, Action* action, const std::vector<std::string>& arguments, SurfaceTools tools);
void AddDemoVerb(CLI::App& app, Action* action);
void AddPriorVerb(CLI::App& app, Action* action);
void AddMotionsVerb(CLI::App& app, Action* action);
void AddTrainVerb(CLI::App& app, Action* action);
/// `arguments`: those of this command, for what goes on in another executable.
void AddAnimateVerb(CLI::App& app, Action* action, std::vector<std::string> arguments);
void AddNeuralVerb(CLI::App& app, Action* action);
void AddVersionVerb(CLI::App& app, Action* action);

// `train avatar`, `animate avatar` and `animate person`, which need no LibTorch and so are this command's own, unlike
// their siblings.

void AddTrainAvatar(CLI::App& train, Action* action);
void AddAnimateAvatar(CLI::App& animate, Action* action);
/// Scores need LibTorch: with --score the command goes on in the executable that has them, which takes `arguments`,
/// those of this one.
void AddAnimatePerson(CLI::App& animate, Action* action, std::vector<std::string> arguments);

}  // namespace bodyloom
