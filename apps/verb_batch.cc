// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "apps/clip_settings.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/base/parallel.h"
#include "pipelines/batch/run_batch.h"

namespace bodyloom {
namespace {

constexpr const char* kBatchFooter =
    "A line of the manifest is a JSON object: the clip's id, its input, and options of `track` or `run`:\n"
    "  {\"id\": \"dance_01\", \"detections\": \"dance_01.json\", \"image-size\": \"1920x1080\", \"fps\": 60}\n"
    "  {\"id\": \"street\", \"video\": \"street.mp4\", \"people\": 2}\n"
    "Results go to DIR/clips/ID, the table of all to DIR/clips.csv, a JSON line a clip to stdout. What is there\n"
    "from the same inputs and options is left.\n\n"
    "Exit codes: 0 all is done, 1 a clip or the manifest cannot be used, or the disk is full, 2 wrong usage,\n"
    "3 some clips show nobody and the rest is done, 130 interrupted.";

struct BatchCommand {
  std::string manifest, out, shard = "0/1";
  int jobs = ThreadsFor(0);
  bool quiet = false;
};

void RunBatchCommand(const BatchCommand& command, const ClipSettings& common) {
  const std::vector<ManifestClip> listed = ManifestFromText(ReadFileBytes(command.manifest), command.manifest);
  RunBatchRequest request;
  request.out = command.out;
  request.jobs = command.jobs;
  for (const ManifestClip& clip : listed) request.ids_of_table.push_back(clip.id);
  for (const ManifestClip& clip : ShardOf(listed, command.shard)) {
    request.clips.push_back(ClipFrom(clip, common, std::max(1, ThreadsFor(0) / command.jobs)));
  }
  Progress progress("clips", command.quiet ? Progress::Style::kSilent : Progress::DefaultStyle());
  PipelineCallbacks callbacks;
  callbacks.progress = [&](const std::string& stage, double fraction) {
    progress.Update(stage, fraction);
    return !IsInterrupted();
  };
  callbacks.message = [&](const std::string& line) {
    progress.Wipe();
    std::cerr << line << std::endl;
  };
  request.on_ended = [&](const ClipRecord& record) {
    progress.Wipe();
    std::cout << ToLine(record) << std::endl;
  };
  const RunBatchReport report = RunBatch(request, callbacks);
  progress.Wipe();
  if (report.clips.contains(ClipStatus::kFailed)) throw CommandEnded(kExitFailed, ToText(report));
  if (report.clips.contains(ClipStatus::kNoPersonFound)) throw CommandEnded(kExitNoPersonFound, ToText(report));
  if (!command.quiet) std::cerr << ToText(report) << "\n";
}

}  // namespace

void AddBatchVerb(CLI::App& app, Action* action) {
  CLI::App* verb =
      app.add_subcommand("batch", "Many clips, each once, however often it is killed; in shards on clusters");
  verb->footer(kBatchFooter);
  auto command = std::make_shared<BatchCommand>();
  verb->add_option("--manifest", command->manifest, "the clips, one JSON object a line")->required()->type_name("FILE");
  verb->add_option("--out", command->out, "folder for the results, made when it is not there")
      ->required()
      ->type_name("DIR");
  verb->add_option("--shard", command->shard, "only every N-th clip, from the i-th on, i counted from 0")
      ->type_name("i/N");
  verb->add_option("--jobs", command->jobs, "clips at once, which share the cores (default: one a core)")
      ->check(CLI::Range(1, 256));
  verb->add_flag("--quiet", command->quiet, "on stderr nothing but what went wrong");
  const std::function<ClipSettings()> common = AddClipOptions(*verb);
  verb->callback([=] { *action = [=] { RunBatchCommand(*command, common()); }; });
}

}  // namespace bodyloom
